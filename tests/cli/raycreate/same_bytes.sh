# The same words give the same bytes, for any number of threads; another seed, another world. The header remembers
# the words.
raycreate -q room 1 --rays 3000 --truth --moving 2 --drift 0.1
for threads in 1 2 3 8; do
  mkdir "t$threads" && cd "t$threads"
  raycreate -q room 1 --rays 3000 --truth --moving 2 --drift 0.1 --threads "$threads"
  for file in room.ply room_scene.ply room_ground.ply room_truth.yaml; do cmp "$file" "../$file"; done
  cd ..
done
raycreate -q room 2 --rays 3000 --truth --moving 2 --drift 0.1 -o second.ply
! cmp -s second.ply room.ply
raycreate -q room 1 --rays 3000 --noise 0.05 -o noisy.ply
rayinfo room.ply | grep -E '^(rays|history|extra)' | cut -d : -f 1
