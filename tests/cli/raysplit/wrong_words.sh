# Values that make no sense, for every form: exit 2, nothing written.
make_cloud cloud.ply 3
mkdir quiet && cp cloud.ply quiet && cd quiet
while read -r words; do
  # shellcheck disable=SC2086  # words
  (unchanged 2 raysplit cloud.ply $words) >../out 2>../err || { echo "$words:"; cat ../out ../err; exit 1; }
  [ ! -s ../out ] && [ -s ../err ]
done <<END
plane
plane 0,0,0
plane 1,2
plane nan,0,1
plane 1e-200,0,0
box 0,0,0
box 0,0,0 1,-1,1
box 0,0,0 1,0,1
capsule 0,0,0 1,1,1 -2
capsule 0,0,0 1,1,1 0
capsule 0,0,0 1
range -1
range far
raydir 0,0,0
time
time 101 %
time -3 %
time 0 %
alpha -0.1
alpha 1.1
colour 0,0,0
colour 2,0,0
single_colour 1.5,0,0
single_colour 256,0,0
gap 0
gap -1
grid 0,0,0
grid 0,0,0,0
grid -1,1,1
grid 1,1,1 -1
grid 1,1,1 2
grid 1,1
trees.txt distance
END
raysplit cloud.ply plane 0,0,0 2>&1 | head -n 1 || true
raysplit cloud.ply time 101 % 2>&1 | head -n 1 || true
raysplit cloud.ply grid 0,0,0 2>&1 | head -n 1 || true
