# Mistakes in every form: exit 2, a caret, nothing written.
make_cloud cloud.ply 3
mkdir quiet && cp cloud.ply quiet && cd quiet
for words in '4 cm 0 points' '4 cm -3 points' '4 cm 1.5 points' '4 cm 5000000000 points' '4 cm 3 rays' '0 cm 3 points' \
  '0 cm/ray' '-4 cm/ray' '4 cm/s' '4 km/ray' 'nan cm/ray' '0 cm/m' '-3 cm/m' 'inf cm/m' '3 cm/m 2 points'; do
  unchanged 2 raydecimate cloud.ply $words 2>../err
  grep -q '\^' ../err || { echo "no caret for: $words"; cat ../err; exit 1; }
done
