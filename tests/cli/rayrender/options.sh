# The size of the image, and options that contradict each other.
make_cloud cloud.ply 500
rayrender -q cloud.ply top ends --resolution 64
rayrender -q cloud.ply front height --resolution 64 -o f.png
[ "$(head -c 8 cloud_top_ends.png | od -An -c | tr -d ' ')" = '211PNG\r\n032\n' ]
width=$(od -An -j16 -N4 -tu1 cloud_top_ends.png | awk '{ print $1 * 16777216 + $2 * 65536 + $3 * 256 + $4 }')
height=$(od -An -j20 -N4 -tu1 cloud_top_ends.png | awk '{ print $1 * 16777216 + $2 * 65536 + $3 * 256 + $4 }')
[ "$width" = 64 ] || [ "$height" = 64 ]
for threads in 1 3 8; do
  rayrender -q cloud.ply top ends --resolution 64 --threads "$threads" -o t.png
  cmp t.png cloud_top_ends.png
done
rm t.png
unchanged 2 rayrender cloud.ply top ends --resolution 64 --pixel_width 0.1 2>../err || true
unchanged 1 rayrender cloud.ply top ends --pixel_width 1e-9
unchanged 2 rayrender cloud.ply top ends --resolution 0 2>/dev/null
unchanged 2 rayrender cloud.ply above ends 2>/dev/null
