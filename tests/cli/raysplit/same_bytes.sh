# Threads, memory and the names of the outputs change no byte.
binary_cloud cloud.ply 40000
for form in 'plane 1,0,0' 'range 3'; do
  raysplit -q cloud.ply $form
  raysplit -q cloud.ply $form --threads 3 --memory 100MB -o other.ply
  cmp cloud_inside.ply other.ply
  cmp cloud_outside.ply other_outside.ply
done
raysplit -q cloud.ply plane 1,0,0
raycombine -q cloud_inside.ply cloud_outside.ply --join -o a.ply --threads 1
raycombine -q all cloud_inside.ply cloud_outside.ply --join -o b.ply --threads 8
rayinfo a.ply | grep ^history
rayinfo b.ply | grep ^history
sed '1,/^end_header/d' a.ply >a.rays
sed '1,/^end_header/d' b.ply | cmp - a.rays
