# Threads change no byte; a pipe gives what the command gives.
binary_cloud cloud.ply 5000
for words in '20 cm' 'range 10 cm'; do
  raydenoise -q cloud.ply $words -o one.ply --threads 1
  for threads in 2 3 8; do
    raydenoise -q cloud.ply $words -o more.ply --threads "$threads"
    cmp one.ply more.ply
  done
  raypipe -q cloud.ply denoise $words -o piped.ply
  cmp one.ply piped.ply
done
