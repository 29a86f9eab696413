# What cannot be wrapped with overhangs: one line, exit 1, nothing written.
make_cloud zero.ply 0
make_cloud one.ply 1
make_cloud some.ply 50
sed '/^end_header/,$ { s/ [0-9]*$/ 0/ }' some.ply >unbounded.ply
cloud_of() { ply_header $# "${ray_properties[@]}"; for i; do echo "$i 1 0 0 2 1 2 3 4"; done; }
cloud_of '1 1 1' '2 2 2' '3 3 3' '4 4 4' >line.ply
cloud_of '1 1 1' '1 1 1' '1 1 1' '1 1 1' '1 1 1' >same.ply
cloud_of '0 0 5' '0 1 5' '1 0 5' '1 1 5' >plane.ply
cloud_of '0 0 1' '0 1 2' '1 0 3' >three.ply
cloud_of '0 0 0' '0 1 0' '1 0 0' '0 0 1' >four.ply
for cloud in zero one unbounded line same; do
  for direction in upwards outwards; do
    unchanged 1 raywrap $cloud.ply $direction 1 --full
  done
done
for cloud in plane three; do
  unchanged 1 raywrap $cloud.ply inwards 1 --full
done
unchanged 1 raywrap four.ply outwards 1000 --full
unchanged 1 raywrap some.ply outwards 0 --full
for words in 'upwards -1' 'inwards nan' 'inwards inf'; do
  # shellcheck disable=SC2086  # words
  unchanged 2 raywrap some.ply $words --full 2>../err
  head -n 1 ../err
done
# A plane is a sheet; four ends are the least that has an inside.
for cloud in plane three four; do
  raywrap $cloud.ply downwards 1 --full | sed 's/ (.*//'
done
raywrap four.ply inwards 1e300 --full | sed 's/ (.*//'
