# Far more cells than files that may be open: every ray is there, in .ply and in .laz.
make_cloud cloud.ply 3000
ulimit -n 40
for type in ply laz; do
  raysplit -q cloud.ply grid 0.5,0.5,0.5 -o "cell.$type"
  [ "$(ls cell_*."$type" | wc -l)" -gt 1000 ]
  raycombine -q cell_*."$type" --join -o "again.$type"
  rayinfo "again.$type" | grep '^rays  *3,000$'
done
ls -A | grep -v '^cell_\|^again\|^cloud' || true
