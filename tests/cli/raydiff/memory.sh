# Clouds that do not fit the memory are compared in 32 blocks: the same bytes, table and figures, and nothing left in
# the folder for temporary files.
board_scan 0 0 a.ply mine
board_scan 1 86400 b.ply mine
raydiff a.ply b.ply --rays 5 | sed "s, in [0-9.]* s$,," >table
raydiff a.ply b.ply --rays 5 --individual --json >one.json
mv a_diff.ply one.ply
mv b_diff.ply two.ply
mkdir temporary
export TMPDIR=$PWD/temporary
for memory in 100kB 900kB; do
  raydiff a.ply b.ply --rays 5 --individual --json --memory $memory | cmp - one.json
  cmp one.ply a_diff.ply
  cmp two.ply b_diff.ply
done
raydiff a.ply b.ply --rays 5 --memory 100kB | sed "s, in [0-9.]* s$,," | cmp - table
[ -z "$(ls temporary)" ]
grep rays one.json
