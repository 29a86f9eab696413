# Values that make no sense: exit 2, nothing written.
make_cloud cloud.ply 3
for words in 'upwards' 'sideways 1' 'upwards -1' 'upwards nan' 'upwards inf' 'upwards 1 2' '1 upwards'; do
  # shellcheck disable=SC2086  # words
  unchanged 2 raywrap cloud.ply $words 2>../err
  head -n 1 ../err
done
