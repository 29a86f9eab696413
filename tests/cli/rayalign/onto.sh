# A room that was scanned twice, the second time from elsewhere in the world.
raycreate -q room 1 --rays 80000 -o monday.ply
raycreate -q room 1 --rays 70000 --moving 1 -o tuesday.ply
rayrotate -q tuesday.ply 0,0,120
raytranslate -q tuesday.ply 30,-40,2
rayalign tuesday.ply monday.ply --output_transform t.yaml >out
sed 's/ ([^)]*)//g; s/ in [0-9.]* s$//' out | grep rayalign:
grep -oE '^(matrix|[a-z]+ ?[a-z]* +)' out | sed 's/ *$//'
grep -E '^rotation' out | awk '{ split($3, v, ","); printf "%.1f %.1f %.1f\n", v[1] + 1e-9, v[2] + 1e-9, v[3] }' | sed 's/-0\.0/0.0/g'
# Back to within a millimetre or two of where it was: the transform undoes the motion.
rayalign tuesday_aligned.ply monday.ply --local -o again.ply | awk '/^translation/ { split($2, v, ","); print (v[1]^2 + v[2]^2 + v[3]^2 < 0.005^2) }'
grep -E '^[a-z_]+:' t.yaml | cut -d: -f1
# Another cloud of the same day follows.
rayalign -q tuesday.ply --apply t.yaml -o follows.ply >/dev/null
rayexport -q tuesday_aligned.ply one.csv - && rayexport -q follows.ply other.csv - && cmp one.csv other.csv
for how in '--threads 1' '--threads 8' '--memory 10MB'; do
  rayalign -q tuesday.ply monday.ply $how -o how.ply >/dev/null
  cmp how.ply tuesday_aligned.ply
done
