# Meshes that are none of a model: one triangle, and faces that no surface has. What can be said of distances is said.
{
  ply_header 4 "${ray_properties[@]}"
  for z in -1 -0.2 0.2 1; do echo "1 1 $z $z 0 0 9 255 0 0 200"; done
} >cloud.ply
ends() { rayexport -q "$1" ends.csv - && cut -d, -f3 ends.csv | tail -n +2 | paste -sd' '; }
printf 'v 0 0 0\nv 3 0 0\nv 0 3 0\nf 1 2 3\n' >one.obj
raysplit cloud.ply one.obj distance 0.5 -o out.ply | sed 's/ (.*//'
ends out.ply
# A third face on an edge; faces that meet at a corner only; the same face twice; a corner that no face has.
{ cat one.obj && printf 'v 0 0 3\nf 1 2 4\nv 3 0 -3\nf 2 1 5\n'; } >three_at_an_edge.obj
{ cat one.obj && printf 'v -3 0 0\nv 0 -3 0\nf 1 4 5\n'; } >at_a_corner.obj
{ cat one.obj && printf 'f 1 2 3\nf 3 2 1\n'; } >twice.obj
{ cat one.obj && printf 'v 1e9 1e9 1e9\n'; } >loose.obj
for mesh in three_at_an_edge at_a_corner twice loose; do
  raysplit cloud.ply $mesh.obj distance 0.5 -o out.ply | sed 's/ (.*//'
  ends out.ply
done
# The heights of one triangle, on it and beside it.
raytranslate cloud.ply add one.obj | sed 's/ (.*//'
