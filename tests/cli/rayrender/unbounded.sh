# Rays that met nothing have no surface to draw, but a sensor and free space.
{
  ply_header 2 "${ray_properties[@]}"
  echo 3 4 0 1 -3 -4 0 9 8 7 0
  echo 3 4 1 2 -3 -4 0 9 8 7 0
} >cloud.ply
rayrender -q cloud.ply top starts
rayrender -q cloud.ply top rays
for style in ends mean sum height; do
  unchanged 1 rayrender cloud.ply top $style
done
