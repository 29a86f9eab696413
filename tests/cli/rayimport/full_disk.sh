# A full disk while importing: one line, exit 1, no cloud.
small_disk 200
make_cloud cloud.ply 20000
rayexport -q cloud.ply points.laz trajectory.txt
cd disk
unchanged 1 rayimport ../points.laz ../trajectory.txt -o cloud.ply
