# Mistakes on the command line: exit 2, nothing written.
make_cloud cloud.ply 3
make_cloud thin.ply 3
mkdir quiet && mv ./*.ply quiet && cd quiet
for words in 'thin.ply 4 cloud.ply' 'thin.ply 4 km cloud.ply' 'thin.ply 0 cm cloud.ply' 'thin.ply -1 cm cloud.ply' \
  'thin.ply 0 rays cloud.ply' 'thin.ply 1.5 rays cloud.ply' 'thin.ply cloud.ply 4 cm' 'thin.ply 4 cm' '4 cm cloud.ply' \
  'thin.ply 4 cm/ray cloud.ply' 'thin.ply 4 cm cloud.ply --rigid' 'thin.ply 4 cm 3 points cloud.ply'; do
  unchanged 2 rayrestore $words 2>../err
done
