# Two branches of a map. One takes the unbounded rays out and adds some, the other recolours what is far away.
said() { sed 's/, wrote.*//'; }
rows() { rayexport -q "$1" "$1.csv" - && sort "$1.csv"; }
binary_cloud base.ply 200
raysplit -q base.ply alpha 0
make_cloud new.ply 20 && raytranslate -q new.ply 0,0,1
raycombine -q base_outside.ply new.ply -o mine.ply
raysplit -q base.ply range 5
raycolour -q base_outside.ply 1,0,0 -o red.ply
raycombine -q base_inside.ply red.ply -o yours.ply
raycombine base.ply all mine.ply yours.ply | said
ls base_*
# What it must be: both edits, one after the other.
raysplit -q yours.ply alpha 0
raycombine -q yours_outside.ply new.ply -o wanted.ply
cmp <(rows base_combined.ply) <(rows wanted.ply)
# A branch that is the base, that has gone another way about the same, that has nothing left.
raycombine base.ply all base.ply yours.ply -o out.ply | said
cmp <(rows out.ply) <(rows yours.ply)
raycombine base.ply all mine.ply base.ply -o out.ply | said
cmp <(rows out.ply) <(rows mine.ply)
raycombine base.ply all mine.ply mine.ply -o out.ply | said
cmp <(rows out.ply) <(rows mine.ply)
ply_header 0 "${ray_properties[@]}" >nothing.ply
raycombine base.ply all nothing.ply mine.ply -o out.ply | said
cmp <(rows out.ply) <(rows new.ply)
# With rays; the differences only where the result is a file of its own.
raycombine base.ply min mine.ply yours.ply 10 rays -o out.ply | said
ls out_*
# As git does it: names that tell nothing, the result in place of a branch, a base without a byte.
mkdir git && cd git
cp ../base.ply .merge_file_O && cp ../mine.ply .merge_file_A && cp ../yours.ply .merge_file_B
raycombine -q .merge_file_O all .merge_file_A .merge_file_B -o .merge_file_A
raycombine -q .merge_file_O newest .merge_file_A .merge_file_B 10 rays -o .merge_file_B
ls -A
cmp <(rows .merge_file_A) <(rows ../base_combined.ply)
: >.merge_file_O && cp ../mine.ply .merge_file_A && cp ../mine.ply .merge_file_B
raycombine .merge_file_O all .merge_file_A .merge_file_B -o .merge_file_A | said
cmp <(rows .merge_file_A) <(rows ../mine.ply)
raycombine -q ../mine.ply -o laz.laz && mv laz.laz .laz_file
raycombine -q .laz_file all .laz_file .laz_file -o .laz_file
[ "$(head -c 4 .laz_file)" = LASF ]
rm .*.csv
# Mistakes change nothing.
echo no cloud >text
unchanged 1 raycombine text all .merge_file_A .merge_file_B 2>>../err
unchanged 1 raycombine .merge_file_A all .merge_file_O .merge_file_B 2>>../err
unchanged 1 raycombine .merge_file_A all .merge_file_A missing 2>>../err
unchanged 2 raycombine .merge_file_A all .merge_file_A .merge_file_B -o out 2>/dev/null
unchanged 2 raycombine .merge_file_A all .merge_file_A 2>/dev/null
unchanged 2 raycombine .merge_file_A min .merge_file_A .merge_file_B 2>/dev/null
unchanged 2 raycombine .merge_file_A all .merge_file_A .merge_file_B 10 rays 2>/dev/null
cat ../err
# Columns: what a branch has added stays with all rays, what one has taken out is gone.
cd ..
raycombine -q base.ply red.ply -o plain.ply
columns() {
  ply_header 2 "${ray_properties[@]}" "${@:2}"
  for i in 1 2; do echo "$i 2 3 4 0 0 2 9 9 9 255 $1"; done
}
columns '7 8' 'uchar old' 'uchar dropped' >base.ply
columns '7 5 8' 'uchar old' 'float added' 'uchar dropped' >mine.ply
columns '7' 'uchar old' >yours.ply
raycombine base.ply all mine.ply yours.ply -o out.ply | said
rayexport -q out.ply out.csv - && cat out.csv
columns '7 1' 'uchar old' 'int more' >yours.ply
unchanged 1 raycombine base.ply all mine.ply yours.ply -o out.ply
