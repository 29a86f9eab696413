# What has no axes, or lies nowhere on the other, is refused in one line, and nothing is written.
raycreate -q room 1 --rays 40000 -o room.ply
raycreate -q tree 1 --rays 40000 -o tree.ply
raycreate -q terrain 1 --rays 40000 -o terrain.ply
unchanged 1 rayalign tree.ply >../out 2>../err
unchanged 1 rayalign room.ply tree.ply --output_transform t.yaml >>../out 2>>../err
unchanged 1 rayalign tree.ply terrain.ply >>../out 2>>../err
raytranslate -q tree.ply 500,0,0
unchanged 1 rayalign room.ply tree.ply --local >>../out 2>>../err
# Flat fields, single lines, a single place, the sky alone, no ray, one ray.
rows() { ply_header "$1" "${ray_properties[@]}"; awk -v rows="$1" -v kind="$2" 'BEGIN { for (i = 0; i < rows; ++i) {
  x = 20 * ((i * 0.754877666) % 1); y = kind == "line" ? 3 : 20 * ((i * 0.569840291) % 1); z = 0; a = 255
  if (kind == "place") x = y = 1
  if (kind == "sky") { z = 90; a = 0 }
  printf "%.4f %.4f %.4f %d %.4f %.4f %.4f 9 9 9 %d\n", x, y, z, i, 10 - x, 10 - y, 3 - z, a } }'; }
for kind in flat line place sky; do rows 5000 $kind >$kind.ply; done
rows 0 none >none.ply
rows 1 flat >one.ply
for kind in flat line place sky none one; do
  unchanged 1 rayalign $kind.ply >>../out 2>>../err
  unchanged 1 rayalign $kind.ply --level >>../out 2>>../err
  unchanged 1 rayalign $kind.ply $kind.ply >>../out 2>>../err
  unchanged 1 rayalign $kind.ply room.ply >>../out 2>>../err
  unchanged 1 rayalign room.ply $kind.ply --local >>../out 2>>../err
done
[ ! -s ../out ]
[ "$(wc -l <../err)" = 34 ]
! grep -v '^rayalign: [a-z]*\.ply: ' ../err
# A transform that is none.
printf 'matrix: [1, 0, 0, 0]\n' >short.yaml
printf '1 0 0 0\n0 2 0 0\n0 0 1 0\n0 0 0 1\n' >scaled.yaml
unchanged 1 rayalign room.ply --apply short.yaml
unchanged 1 rayalign room.ply --apply scaled.yaml
unchanged 1 rayalign room.ply --apply missing.yaml
unchanged 1 rayalign room.ply --output_transform no/folder/t.yaml
