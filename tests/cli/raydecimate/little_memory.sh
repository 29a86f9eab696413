# The same bytes in little memory, however many threads.
binary_cloud cloud.ply 6000
for form in '1 cm' '2 cm 3 points' '5 cm/ray' '1 cm/m'; do
  raydecimate -q cloud.ply $form -o a.ply
  for memory in 1kB 30kB 200kB; do
    raydecimate -q cloud.ply $form --memory $memory --threads 3 -o b.ply
    cmp a.ply b.ply
  done
done
