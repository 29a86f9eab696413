# Mistakes on the command line: exit 2, nothing written, and a line that says what is wrong.
make_cloud cloud.ply 3
mkdir quiet && cp cloud.ply quiet && cd quiet
for words in '' 'cloud.ply' 'cloud.ply 10 rays' 'min cloud.ply' 'min cloud.ply 10' 'min cloud.ply 0 rays' 'min cloud.ply -3 rays' \
  'min cloud.ply 2.5 rays' 'min cloud.ply 10 cm' 'min 10 rays' 'least cloud.ply 10 rays' 'min cloud.ply 10 rays --colour 3' \
  'min max cloud.ply 10 rays' 'order cloud.ply 10 rays'; do
  unchanged 2 raytransients $words 2>>../err
done
grep '^raytransients: ' ../err | grep -v ': take out'
