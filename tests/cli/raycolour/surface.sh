# By shape, normal and branches, and lit: clouds whose colours can be worked out. The rows have red, green, blue and
# alpha; a level floor of 11 by 11 points seen from above, and a ray that hit nothing.
{
  ply_header 122 "${ray_properties[@]}"
  for i in $(seq 0 120); do echo "$((i % 11)) $((i / 11)) 0 $i 0 0 9 10 100 200 40"; done
  echo "3 3 20 130 0 0 -9 10 100 200 0"
} >floor.ply
# colours FILE WORDS…: the colours that there are, each with how many have it.
colours() {
  local file=$1
  shift
  echo "$file $*"
  raycolour -q "$file" "$@" -o out.ply
  rayexport -q out.ply out.csv - && tail -n +2 out.csv | cut -d, -f5- | LC_ALL=C sort | uniq -c | sed 's/^ */  /'
}
types=(time height alpha 'alpha 0.2' 'alpha 0' 1,0.5,0 shape normal branches)
colours floor.ply normal
colours floor.ply normal --lit
colours floor.ply 1,0.5,0 --lit
colours floor.ply alpha 0 --lit

# Fewer rays than neighbours, one, none; all in one place; all unbounded.
small() { # NAME ROWS ROW
  { ply_header "$2" "${ray_properties[@]}"; for _ in $(seq "$2"); do echo "$3"; done; } >"$1.ply"
}
make_cloud few.ply 8
small one 1 '1 2 3 4 0 0 5 10 100 200 40'
small none 0 ''
small same 100 '1 2 3 4 0 0 5 10 100 200 40'
small nothing 100 '1 2 3 4 0 0 5 10 100 200 0'
for file in one none same nothing; do
  for words in shape normal branches 'normal --lit' 'alpha 0.2 --lit'; do
    colours "$file.ply" $words
  done
done

# Each with each leaves what is not a colour; the same bytes for any threads and in little memory.
rayrender -q floor.ply top ends -o map.png
make_cloud many.ply 3000
for words in "${types[@]}" 'image map.png'; do
  for lit in '' --lit; do
    raycolour -q few.ply $words $lit -o out.ply
    raycolour -q many.ply $words $lit -o out.ply
    raycolour -q many.ply $words $lit -o again.ply --memory 30KB --threads 3
    cmp <(tail -c 90000 out.ply) <(tail -c 90000 again.ply)
  done
done
mkdir quiet && cp many.ply quiet && cd quiet
TMPDIR=nowhere unchanged 1 raycolour many.ply shape --memory 30KB 2>../err
grep -q '^raycolour: nowhere: cannot make a temporary file' ../err
