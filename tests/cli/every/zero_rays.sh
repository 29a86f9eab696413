# A cloud without rays is legal: commands from cloud to cloud give one, a picture of it is refused.
make_cloud zero.ply 0
raydecimate zero.ply 10 cm -o thin.ply
raydecimate zero.ply 10 rays -o every.ply
raysmooth zero.ply
raytranslate thin.ply 1,2,3
rayrotate thin.ply 0,0,90
rayexport thin.ply points.ply -
rayexport thin.ply points.laz -
rayexport thin.ply points.txt -
rayinfo thin.ply | grep -q '^rays  *0$'
rayinfo thin.ply --json --check >/dev/null
rayinfo every.ply --check | grep -q '^rays  *0$'
unchanged 1 rayrender thin.ply top ends
raydecimate thin.ply 1 cm -o thin.laz
rayinfo thin.laz | grep -q '^rays  *0$'
rayexport thin.ply - trajectory.txt
