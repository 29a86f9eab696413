# A cloud far from the origin keeps 0.1 mm through import, decimation, rotation about the origin and LAZ.
awk 'BEGIN { print "x,y,z,time"; for (i = 0; i < 200; ++i)
  printf "%.4f,%.4f,%.4f,%d\n", 500000 + i * 0.0371, 6900000 + i * 0.0533, 100 + (i * 37 % 101) / 97, i }' >points.csv
rayimport -q points.csv 500000,6900000,102 -o cloud.ply
rayinfo cloud.ply | grep -q '^precision  *double'
raydecimate -q cloud.ply 1 mm -o thin.ply
rayrotate -q thin.ply 0,0,77.7
raydecimate -q thin.ply 1 ray -o turned.laz
raydecimate -q turned.laz 1 ray -o back.ply
rayrotate -q back.ply 0,0,-77.7
rayexport -q back.ply back.csv -
paste -d, <(cut -d, -f1-3 points.csv) <(cut -d, -f1-3 back.csv) | awk -F, '
  NR > 1 { for (i = 1; i <= 3; ++i) { d = $i - $(i + 3); if (d < 0) d = -d; if (d > worst) worst = d } }
  END { exit !(NR == 201 && worst <= 1e-4) } '
