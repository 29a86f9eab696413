# A full disk while splitting: one line, exit 1, no cloud, nothing left behind.
small_disk 300
binary_cloud cloud.ply 20000
cd disk
unchanged 1 raysplit ../cloud.ply plane 1,0,0 -o half.ply
unchanged 1 raysplit ../cloud.ply grid 2,2,0 -o cell.ply
unchanged 1 raycombine ../cloud.ply -o all.ply
