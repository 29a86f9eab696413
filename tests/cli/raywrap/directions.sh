# From each side; the numbers are those of the library, whose tests say that they are right.
raycreate -q room 1 --rays 20000 -o room.ply
for words in 'upwards 0' 'upwards 1' 'downwards 1' 'inwards 0' 'inwards 1' 'outwards 4' \
  'upwards 1e300' 'downwards 1e308' 'inwards 1e308' 'outwards 1e308'; do
  raywrap room.ply $words -o mesh.ply | sed 's/ (.*//'
  raywrap -q room.ply $words --threads 3 --memory 100MB -o other.ply
  cmp mesh.ply other.ply
done
raywrap -q room.ply upwards 1
raywrap -q room.ply upwards 1 -o other.obj
raysplit -q room.ply room_mesh.ply distance -0.000001
rayinfo room_outside.ply | grep bounded
