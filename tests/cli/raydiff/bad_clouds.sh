# Clouds of which little or nothing can be told.
rows() { ply_header "$1" "${ray_properties[@]}"; for i in $(seq "$1"); do echo "${2//NUMBER/$i}"; done; }
rows 0 '' >none.ply
rows 1 '1 2 3 4 0 0 2 9 9 9 255' >one.ply
rows 5 'NUMBER 2 3 NUMBER 0 0 2 9 9 9 0' >unbounded.ply
rows 5 '1 2 3 7 0 0 2 9 9 9 255' >one_place.ply
rows 5 'NUMBER 900 3 7 0 0 2 9 9 9 255' >far.ply
{ rows 6 'NUMBER 900 3 7 0 0 2 9 9 9 255' | head -n -2; printf 'nan 1 1 1 0 0 1 9 9 9 255\n1 1 inf 1 0 0 1 9 9 9 255\n'; } >nan.ply
for pair in 'none none' 'none one' 'one one' 'unbounded one' 'unbounded unbounded' 'one_place one_place' 'far one' 'nan far'; do
  echo "== $pair"
  raydiff ${pair% *}.ply ${pair#* }.ply -o out.ply | sed 's/, wrote.*//'
done
raydiff far.ply one.ply --json -o out.ply | grep similarity
rm out.ply
unchanged 1 raydiff one.ply missing.ply 2>../err
unchanged 1 raydiff far.ply one.ply --distance 1e-19m 2>>../err
printf 'ply\n' >cut.ply
unchanged 1 raydiff one.ply cut.ply 2>>../err
for words in '' 'one.ply' 'one.ply one.ply one.ply' 'one.ply one.ply --distance 0cm' 'one.ply one.ply --distance -5cm' \
  'one.ply one.ply --distance 5' 'one.ply one.ply --rays 0' 'one.ply one.ply --rays 2.5'; do
  unchanged 2 raydiff $words 2>>../err
done
grep '^raydiff: ' ../err | grep -v ': what came'
