# A full disk while a cloud is moved in place: one line, exit 1, the cloud as it was, nothing left behind.
small_disk 300
binary_cloud cloud.ply 5000
cp cloud.ply disk/
cd disk
unchanged 1 raytranslate cloud.ply 1,2,3
unchanged 1 rayrotate cloud.ply 0,0,45
cmp cloud.ply ../cloud.ply
