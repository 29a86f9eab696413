# Lifting a cloud onto a mesh, and setting it down.
{
  ply_header 3 "${ray_properties[@]}"
  echo "5 0 2 1 -5 0 9 255 0 0 200"
  echo "-10 10 2 2 0 0 9 0 255 0 200"
  echo "30 40 2 3 0 0 9 0 0 255 0"
} >cloud.ply
cp cloud.ply start.ply
make_ground ground.ply
rows() { rayexport -q "$1" ends.csv path.csv && cut -d, -f1-3 ends.csv && cat path.csv; }
raytranslate cloud.ply subtract ground.ply | sed 's/ (.*//'
rows cloud.ply
raytranslate -q cloud.ply add ground.ply
raydecimate -q start.ply 1 ray
raydecimate -q cloud.ply 1 ray
cmp <(rows start_decimated.ply) <(rows cloud_decimated.ply)
raytranslate cloud.ply sub ground.ply 2>&1 | head -n 1 || true

mkdir quiet && cd quiet && bad_meshes && cp ../cloud.ply .
printf 'v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n' >wall.obj
for mesh in *.obj cut.ply empty.ply index.ply n*.ply none.obj cloud.ply; do
  unchanged 1 raytranslate cloud.ply add "$mesh" 2>>../err
done
cat ../err
