# A hundred moves there and back stay within 0.1 mm of where each point was, for a cloud that starts in single
# precision, by translation and by rotation.
ends() { rayexport -q "$1" "$1.csv" - && cut -d, -f1-3 "$1.csv"; }
binary_cloud start.ply 2000
for move in 'raytranslate 123.456,-78.9,0.123' 'rayrotate 10,-20,33.3'; do
  set -- $move
  cp start.ply cloud.ply
  for _ in $(seq 100); do
    "$1" -q cloud.ply "$2"
    "$1" -q cloud.ply "$(echo "$2" | sed 's/\([-0-9.]*\),\([-0-9.]*\),\([-0-9.]*\)/-\1,-\2,-\3/; s/--//g')"
  done
  paste -d, <(ends start.ply) <(ends cloud.ply) | awk -F, -v move="$move" '
    NR > 1 { for (i = 1; i <= 3; ++i) { d = $i - $(i + 3); if (d < 0) d = -d; if (d > worst) worst = d } }
    END { print (worst <= 1e-4 && NR == 2001 ? "within 0.1 mm" : move " is off by " worst " m in " NR " rows") }'
done
