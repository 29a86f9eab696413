# Where there is no ground: one line, exit 1, nothing written; and words that make no sense.
make_cloud zero.ply 0
make_cloud one.ply 1
make_cloud some.ply 50
sed '/^end_header/,$ { s/ [0-9]*$/ 0/ }' some.ply >unbounded.ply
for cloud in zero one unbounded; do
  unchanged 1 rayextract terrain $cloud.ply
done
for words in 'trunks some.ply' 'terrain' 'terrain some.ply --gradient 0' 'terrain some.ply --gradient -1' \
  'terrain some.ply --gradient nan' 'terrain some.ply --tolerance 3'; do
  # shellcheck disable=SC2086  # words
  unchanged 2 rayextract $words 2>../err
  head -n 1 ../err >&2
done
