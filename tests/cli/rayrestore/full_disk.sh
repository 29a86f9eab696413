# A full disk: one line, exit 1, nothing left behind.
small_disk 900
binary_cloud cloud.ply 10000
raydecimate -q cloud.ply 10 rays -o thin.ply
cp cloud.ply thin.ply disk/
cd disk
unchanged 1 rayrestore thin.ply 10 rays cloud.ply
