# The signed distance from a mesh: above an open one and outside a closed one it is positive.
{
  ply_header 6 "${ray_properties[@]}"
  for x in -5 5; do
    for z in -2 0.6 2; do echo "$x 0 $z $((x + 20)).5 0 0 9 255 0 0 200"; done
  done
} >cloud.ply
ends() { rayexport -q "$1" ends.csv - && cut -d, -f1-3 ends.csv | tail -n +2 | paste -sd' '; }
make_ground ground.ply
raysplit cloud.ply ground.ply distance 0.5 | sed 's/ (.*//'
ends cloud_inside.ply
ends cloud_outside.ply
# Turned upside down it is the same ground; below it distances are negative.
sed 's/^3 0 1 2$/3 1 0 2/; s/^3 0 2 3$/3 2 0 3/' ground.ply >turned.ply
raysplit -q cloud.ply turned.ply distance -1
ends cloud_inside.ply

# A box as a modelling program writes it: quads, fronts inside, each with its own corners.
box() {
  awk 'BEGIN {
    split("0 2 3 1 4 5 7 6 0 1 5 4 2 6 7 3 0 4 6 2 1 3 7 5", corner, " ")
    for (i = 1; i <= 24; ++i) { c = corner[i]; print "v", (c % 2 ? 6 : 1), (int(c / 2) % 2 ? 1 : -1), (c > 3 ? 1 : -1) }
    for (i = 1; i <= 24; i += 4) print "f", i "/1/1", i + 3 "/1/1", i + 2 "/1/1", i + 1 "/1/1"
  }'
}
box >box.obj
raysplit cloud.ply box.obj distance 0 -o out.ply | sed 's/ (.*//'
ends out_outside.ply
box | head -n 29 >lidless.obj
raysplit cloud.ply lidless.obj distance 0 -o out.ply | sed 's/ (.*//'
box | sed '$p; $s/f .*/f 1 1 2/' >folded.obj
raysplit cloud.ply folded.obj distance 0 -o out.ply | sed 's/ (.*//'

mkdir quiet && cd quiet && bad_meshes && cp ../cloud.ply .
for mesh in *.obj cut.ply empty.ply index.ply n*.ply none.obj cloud.ply; do
  unchanged 1 raysplit cloud.ply "$mesh" distance 1 2>>../err
done
cat ../err
