# A cloud without rays gives two, or none.
make_cloud zero.ply 0
for form in 'plane 0,0,1' 'range 1' 'time 3 %' 'gap 1'; do
  raysplit -q zero.ply $form
  rayinfo zero_inside.ply | grep -q '^rays  *0$'
  rayinfo zero_outside.ply | grep -q '^rays  *0$'
done
raycombine -q zero_inside.ply zero_outside.ply zero.ply
rayinfo zero_inside_combined.ply | grep '^rays  *0$'
raysplit -q zero.ply plane 0,0,1
raycombine zero_inside.ply zero_outside.ply --join -o again.ply | head -n 1
raysplit zero.ply grid 1,1,1 | head -n 1
raysplit zero.ply colour | head -n 1
ls
