# A hundred moves there and back stay within 0.1 mm of where each point was, for clouds that start in single
# precision, near the origin and as far from it as single precision goes, and beyond.
ends() { rayexport -q "$1" "$1.csv" - && cut -d, -f1-3 "$1.csv"; }

# cloud_of_size FACTOR: start.ply in single precision, the usual scene FACTOR times as large.
cloud_of_size() {
  make_cloud scene.ply 1000
  sed 's/^property double \([xyzn]\)/property float \1/' scene.ply | awk -v factor="$1" '
    body { for (i = 1; i <= 3; ++i) $i *= factor; for (i = 5; i <= 7; ++i) $i *= factor } { print }
    /^end_header/ { body = 1 }' >ascii.ply
  raydecimate -q ascii.ply 1 ray -o start.ply
  rayinfo start.ply | grep -q '^precision  *single'
}

there_and_back() {
  local back
  back=$(echo "$2" | sed 's/\([-0-9.]*\),\([-0-9.]*\),\([-0-9.]*\)/-\1,-\2,-\3/; s/--//g')
  cp start.ply cloud.ply
  for _ in $(seq 100); do
    "$1" -q cloud.ply "$2"
    "$1" -q cloud.ply "$back"
  done
  paste -d, <(ends start.ply) <(ends cloud.ply) | awk -F, -v move="$*" '
    NR > 1 { for (i = 1; i <= 3; ++i) { d = $i - $(i + 3); if (d < 0) d = -d; if (d > worst) worst = d } }
    END { print (worst <= 1e-4 && NR == 1001 ? "within 0.1 mm" : move " is off by " worst " m in " NR " rows") }'
}

for factor in 9 40; do
  cloud_of_size "$factor"
  there_and_back raytranslate 123.456,-78.9,0.123
  there_and_back rayrotate 10,-20,33.3
done
