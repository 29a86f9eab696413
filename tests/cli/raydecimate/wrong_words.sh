# Mistakes on the command line: what is wrong, a caret under it, the closest usage; exit 2; nothing written.
make_cloud cloud.ply 3
mkdir quiet && cp cloud.ply quiet && cd quiet
for words in '4' '4 km' '-4 cm' '0 cm' 'four cm' '0 rays' '1.5 rays' '4 cm extra' '10 rays --resolution 3' 'nan cm' 'inf cm'; do
  unchanged 2 raydecimate cloud.ply $words 2>../err
  grep -q '\^' ../err || { echo "no caret for: $words"; cat ../err; exit 1; }
done
