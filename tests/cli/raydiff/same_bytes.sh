# The same bytes, table and figures by any number of threads and any --memory.
raycreate -q room 3 --rays 60000 -o a.ply
raycreate -q room 3 --rays 50000 --static --moving 2 -o b.ply
raydiff a.ply b.ply --json >one.json
mv a_diff.ply one.ply
for how in '--threads 1' '--threads 2' '--threads 8' '--memory 10MB'; do
  raydiff a.ply b.ply $how --json | cmp - one.json
  cmp one.ply a_diff.ply
done
