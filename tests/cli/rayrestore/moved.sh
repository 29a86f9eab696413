# A motion of the thin cloud becomes one of the full cloud; the header tells what happened.
binary_cloud cloud.ply 5000
raydecimate -q cloud.ply 50 cm
raytranslate -q cloud_decimated.ply 1,2,3
rayrestore cloud_decimated.ply 50 cm cloud.ply -o moved.ply | grep -v wrote
cp cloud.ply expected.ply
raytranslate -q expected.ply 1,2,3
for file in moved expected; do
  rayexport -q $file.ply $file.csv -
  cut -d, -f1-4 $file.csv | awk -F, 'NR > 1 { printf "%.3f %.3f %.3f %s\n", $1, $2, $3, $4 }' >$file.txt
done
cmp moved.txt expected.txt
rayinfo moved.ply | grep '^history'
