# Threads change no byte; a pipe gives what the command gives; the columns come again.
binary_cloud cloud.ply 5000
for kind in min newest; do
  raytransients -q $kind cloud.ply 2 rays --colour -o one.ply --threads 1
  for threads in 2 3 8; do
    raytransients -q $kind cloud.ply 2 rays --colour -o more.ply --threads "$threads"
    cmp one.ply more.ply
    cmp one_transient.ply more_transient.ply
  done
  raypipe -q cloud.ply transients $kind 2 rays --colour fixed -o piped.ply
  cmp one.ply piped.ply
done
raytransients -q min one.ply 2 rays -o again.ply
rayinfo again.ply | grep -c '^extra column'
