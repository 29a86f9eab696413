# Each world makes a cloud of the number of rays asked for, with its truth beside it.
for world in room building tree terrain; do
  raycreate -q "$world" 3 --rays 2000 --truth
  rayinfo --check "$world.ply" >/dev/null
  rayinfo "$world.ply" | grep '^rays'
  grep -E '^(scene|seed|rays|scanner|beams):' "${world}_truth.yaml" | tr '\n' ' '
  echo
done
raycreate -q room 1 --rays 2000 --static --truth -o standing.ply
grep -E '^scanner:' standing_truth.yaml
raycreate -q tree 1 --rays 1 --beams 64 -o one.laz
rayinfo one.laz | grep '^rays'
ls
