# Clouds of which little or nothing can be told.
rows() { ply_header "$1" "${ray_properties[@]}"; for i in $(seq "$1"); do echo "${2//NUMBER/$i}"; done; }
rows 0 '' >none.ply
rows 1 '1 2 3 4 0 0 2 9 9 9 255' >one.ply
rows 5 'NUMBER 2 3 NUMBER 0 0 2 9 9 9 0' >unbounded.ply
rows 5 'NUMBER 2 3 7 0 0 2 9 9 9 255' >one_time.ply
rows 5 'NUMBER 900 3 7 0 0 2 9 9 9 255' >far.ply
for pair in 'none none' 'none one' 'one one' 'unbounded none' 'unbounded unbounded' 'one_time far'; do
  for kind in min order newest; do
    case "$pair $kind" in 'one_time far newest') continue ;; esac
    raycombine $kind ${pair% *}.ply ${pair#* }.ply 1 ray -o out.ply | grep -v 'gave way' | sed "s/^raycombine/$kind $pair/; s/, wrote.*//"
  done
done
# Times are needed by some only.
{
  ply_header 5 "${ray_properties[@]/*time/}" | sed '/^property $/d'
  for i in 1 2 3 4 5; do echo "$i 2 3 0 0 2 9 9 9 255"; done
} >no_times.ply
for kind in min max order; do
  raycombine $kind no_times.ply far.ply 1 ray -o out.ply | sed "s/^raycombine/$kind no_times far/; s/, wrote.*//"
done
rm out*
for kind in oldest newest; do
  unchanged 1 raycombine $kind one_time.ply far.ply 10 rays
done
unchanged 1 raycombine min one.ply missing.ply 10 rays
make_cloud cloud.ply 3
for words in 'min' 'min cloud.ply 10 rays' 'min cloud.ply cloud.ply' 'min cloud.ply cloud.ply 10' 'min cloud.ply cloud.ply 0 rays' \
  'min cloud.ply cloud.ply -3 rays' 'min cloud.ply cloud.ply 2.5 rays' 'least cloud.ply cloud.ply 10 rays' \
  'all cloud.ply cloud.ply 10 rays' 'min cloud.ply cloud.ply 10 rays --join' 'cloud.ply cloud.ply --paper'; do
  unchanged 2 raycombine $words 2>>../wrong
done
grep '^raycombine: ' ../wrong | grep -v ': put ray'
