# One ray goes through every command.
make_cloud one.ply 1
raydecimate one.ply 10 cm -o thin.ply
raysmooth thin.ply
raytranslate thin.ply 1,2,3
rayrotate thin.ply 0,0,90
rayrender thin.ply top ends
rayrender thin.ply front height --pixel_width 0.1 -o front.png
rayexport thin.ply points.laz trajectory.txt
rayimport points.laz trajectory.txt -o again.ply
rayinfo again.ply --check | grep -q '^rays  *1$'
