# A board stands before a wall in the second half of the scan: what each word takes out, and what is said.
{
  ply_header 20000 "${ray_properties[@]}" 'uchar mine'
  awk 'BEGIN {
    for (i = 0; i < 20000; ++i) {
      x = -2 + 4 * (i * 0.754877666 % 1)
      z = 3 * (i * 0.569840291 % 1)
      board = i >= 10000 && x > -1 && x < 1 && z > 1 && z < 2
      y = board ? 4 : 8
      printf "%.4f %.4f %.4f %.4f %.4f %.4f %.4f 9 9 9 %d %d\n", x * y / 8, y, z * y / 8, i / 400, -x * y / 8, -y, -z * y / 8,
        i % 50 == 49 ? 0 : 255, board
    }
  }'
} >cloud.ply
for kind in min max oldest newest; do
  raytransients $kind cloud.ply 10 rays | sed 's/, wrote .*//'
  rayinfo cloud_transient.ply | grep -E '^(rays|time|extra column *(mine|trans))'
done
rayinfo cloud_fixed.ply | grep -E '^(rays|extra|history)'
