# Mistakes on the command line: exit 2, nothing written.
make_cloud cloud.ply 3
mkdir quiet && cp cloud.ply quiet && cd quiet
for words in '' '4' '0 cm' '-4 cm' 'nan cm' 'inf m' '4 km' '4 rays' '4 cm 5' 'range' 'range 4' 'range 0 cm' 'range 3 sigmas' \
  '0 sigmas' '-3 sigmas' '3 sigma s' 'sigmas 3' 'far 4 cm' '4 cm --min_neighbours 0' '4 cm --min_neighbours -1' \
  '4 cm --min_neighbours 1.5' '4 cm --min_neighbours 5000000000' 'range 4 cm --min_neighbours 2'; do
  unchanged 2 raydenoise cloud.ply $words 2>../err
done
# A distance so small that places cannot be told apart fails, and leaves nothing.
for words in '1e-15 mm'; do
  unchanged 1 raydenoise cloud.ply $words 2>../err
  grep -q 'too large for so small a distance' ../err
done
