# A room to its own axes. Numbers are rounded: their last digits are those of the machine.
rounded() { awk '{ for (i = 2; i <= NF; ++i) if ($i ~ /^-?[0-9.]+,/) { split($i, v, ","); $i = ""; for (k = 1; k <= 3; ++k) $i = $i sprintf("%s%.1f", k > 1 ? "," : "", v[k] + (v[k] < 0 && v[k] > -0.05 ? 0.05 : 0)) } print }'; }
raycreate -q room 1 --rays 60000 -o room.ply
raycreate -q room 1 --rays 60000 -o turned.ply
rayrotate -q turned.ply 0,0,35
raytranslate -q turned.ply 400000,5000000,30
rayalign room.ply >out
grep rotation out | rounded
sed -n 's/ ([^)]*)//g; s/ in [0-9.]* s$//; /^rayalign/p' out
rayalign turned.ply --output_transform t.yaml | grep -E 'rotation' | rounded
# Both come to lie alike, to a few centimetres; what is aligned stays where it is.
rayinfo room_aligned.ply | grep -E '^(rays|  bounded)'
grep -E '^[a-z_]+:' t.yaml | cut -d: -f1
rayalign turned_aligned.ply -o again.ply | grep rotation | rounded
# The transform of the file does the same again, to the last bit, and keeps all else.
rayalign -q turned.ply --apply t.yaml -o applied.ply >/dev/null
rayexport -q turned_aligned.ply one.csv -
rayexport -q applied.ply other.csv -
cmp one.csv other.csv
# Roll and pitch.
rayrotate -q room.ply 3,-4,0
rayalign room.ply --level -o level.ply | grep -E 'rotation' | rounded
# Nothing printed but the transform.
rayalign -q turned.ply --apply t.yaml -o applied.ply | wc -l
# The same bytes by any number of threads and any --memory.
for how in '--threads 1' '--threads 2' '--threads 8' '--memory 10MB'; do
  rayalign -q turned.ply $how -o how.ply >/dev/null
  cmp how.ply turned_aligned.ply
done
