# Real pairs, where they are at hand: of which the transforms are known to about 0.3 degrees and 5 cm, small_gicp's
# example (MIT) and two car sweeps of libpointmatcher (BSD), one of them tilted by 12 degrees; two sweeps of a scanner
# in the hand, a moment apart and tilted against each other by 40 degrees (Newer College); and 5 s of a walk onto
# another 5 s of it, whose poses are known (BALM).
data=${RAYCLOUD_TEST_DATA:-} above=$CLI
while [ -z "$data" ] && [ "$above" != / ]; do
  above=$(dirname "$above")
  [ -d "$above/shared/data" ] && data=$above/shared/data
done
[ -e "$data/small_gicp_source.ply.xz" ] && [ -e "$data/car_cloud400.csv" ] && command -v xz >/dev/null || {
  echo 'no such files: set RAYCLOUD_TEST_DATA'
  exit 77
}
# off OUT TRUTH DEGREES METRES: whether the matrix printed is within these of the true one.
off() {
  { tr -s ' \n' ' ' <"$2"; echo; grep -A 3 '^matrix' "$1" | tail -n 3; } | awk -v degrees="$3" -v metres="$4" '
    NR == 1 { for (i = 1; i <= 12; ++i) truth[i] = $i }
    NR > 1 { for (k = 1; k <= 3; ++k) trace += $k * truth[4 * (NR - 2) + k]; shift += ($4 - truth[4 * (NR - 2) + 4]) ^ 2 }
    END { c = (trace - 1) / 2; if (c > 1) c = 1; turn = atan2(sqrt(1 - c * c), c) * 57.29578
          if (turn > degrees || sqrt(shift) > metres) { print "off by", turn, "degrees and", sqrt(shift), "m"; exit 1 } }'
}
for name in source target; do
  xz -dkc "$data/small_gicp_$name.ply.xz" >$name.ply
  rayimport -q $name.ply 0,0,0 -o cloud_$name.ply 2>/dev/null
done
rayalign cloud_source.ply cloud_target.ply -o aligned.ply >out
off out "$data/small_gicp_T_target_source.txt" 0.4 0.08
for name in 400 401; do
  { echo x,y,z; tail -n +2 "$data/car_cloud$name.csv" | tr ',' ' ' | awk 'NF >= 3 { print $1 "," $2 "," $3 }'; } >$name.csv
  rayimport -q $name.csv 0,0,0 -o car_$name.ply 2>/dev/null
done
tr ',' ' ' <"$data/carCloudList.csv" | awk '/401/ { for (i = 2; i <= 13; ++i) printf "%s ", $i }' >truth.txt
rayalign car_401.ply car_400.ply -o aligned.ply >out
off out truth.txt 0.4 0.08

for name in 00 01; do xz -dkc "$data/newer_college_$name.ply.xz" >held_$name.ply; done
for pair in '00 01' '01 00'; do
  rayalign "held_${pair% *}.ply" "held_${pair#* }.ply" -o aligned.ply >out
  awk -v pair="$pair" '/^translation/ { split($2, t, ","); if (t[1] ^ 2 + t[2] ^ 2 + t[3] ^ 2 > 1) { print pair, "is far off:", $0; exit 1 } }
    /^rotation/ { split($3, r, ","); turn = sqrt(r[1] ^ 2 + r[2] ^ 2 + r[3] ^ 2); if (turn < 49 || turn > 51) { print pair, "is turned:", $0; exit 1 } }' out
done
xz -dkc "$data/balm.ply.xz" >walk.ply
raysplit -q walk.ply grid 0,0,0,5
set -- walk_*.ply
cp "$2" there.ply && cp "$5" here.ply
rayrotate -q here.ply 0,0,90
raytranslate -q here.ply 10,20,1
printf '0 1 0 -20\n-1 0 0 10\n0 0 1 -1\n' >truth.txt
rayalign here.ply there.ply -o aligned.ply >out
off out truth.txt 0.4 1
