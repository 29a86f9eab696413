# With overhangs: the numbers are those of the library, whose tests say that they are right.
raycreate -q room 1 --rays 5000 -o room.ply
for words in 'upwards 0' 'upwards 1' 'downwards 1' 'inwards 0' 'inwards 1' 'inwards 1e300' 'outwards 4'; do
  # shellcheck disable=SC2086  # words
  raywrap room.ply $words --full -o mesh.ply | sed 's/ (.*//'
  # shellcheck disable=SC2086
  raywrap -q room.ply $words --full --threads 3 --memory 100MB -o other.ply
  cmp mesh.ply other.ply
done
raywrap -q room.ply inwards 1 --full
raysplit -q room.ply room_mesh.ply distance 0.000001
rayinfo room_outside.ply | grep '  bounded'
# As far away as a map of a country has it.
raytranslate -q room.ply 500000,5000000,300
raywrap room.ply inwards 1 --full -o mesh.ply | sed 's/ (.*//'
