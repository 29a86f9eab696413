# What cannot be wrapped: one line, exit 1, nothing written.
make_cloud zero.ply 0
make_cloud one.ply 1
make_cloud some.ply 50
sed '/^end_header/,$ { s/ [0-9]*$/ 0/ }' some.ply >unbounded.ply
{ ply_header 9 "${ray_properties[@]}"; for i in 1 2 3 4 5 6 7 8 9; do echo "$i $i $((i * i)) $i 0 0 2 1 2 3 4"; done; } >line.ply
{ ply_header 4 "${ray_properties[@]}"; for i in '0 0' '0 1' '1 0' '1 1'; do echo "$i 5 1 0 0 2 1 2 3 4"; done; } >plane.ply
{ ply_header 3 "${ray_properties[@]}"; for i in '0 0 1' '0 1 2' '1 0 3'; do echo "$i 1 0 0 2 1 2 3 4"; done; } >three.ply
{ ply_header 3 "${ray_properties[@]}"; for i in 1 2 3; do echo "1 2 3 $i 0 0 2 1 2 3 4"; done; } >same.ply
for cloud in zero one unbounded line same; do
  unchanged 1 raywrap $cloud.ply upwards 1
done
unchanged 1 raywrap line.ply downwards 1
for cloud in zero one unbounded line plane three same; do
  unchanged 1 raywrap $cloud.ply inwards 1
done
for cloud in line plane same; do
  unchanged 1 raywrap $cloud.ply outwards 1
done
unchanged 1 raywrap some.ply outwards 0.001
raywrap -q plane.ply downwards 0
raywrap three.ply upwards 1e300 | sed 's/ (.*//'
