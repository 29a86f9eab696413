# Mistakes on the command line: exit 2, nothing written.
make_cloud cloud.ply 3
mkdir quiet && cp cloud.ply quiet && cd quiet
for words in '' 'alpha -1' 'alpha 2' 'alpha nan' '255,0,0' '1,0' '-1,0,0' 'nan,0,0' 'image' 'shade' 'time 5' 'normal 5' 'shape branches' '--lit' 'normal --lit 3'; do
  unchanged 2 raycolour cloud.ply $words 2>../err
done
