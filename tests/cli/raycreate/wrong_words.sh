# Mistakes on the command line: exit 2, nothing written.
for words in 'room' 'room 0' 'room -1' 'room 1.5' 'room one' 'room 1 2' 'castle 1' 'forest 0' 'forest -1' 'terrain 0' \
  'terrain 1.5' 'room 1 --rays 0' 'room 1 --rays -5' 'room 1 --noise -1' 'room 1 --noise nan' 'room 1 --beams 24' \
  'room 1 --moving 0' 'room 1 --moving -2' 'room 1 --drift 0' 'room 1 --static --beams 16'; do
  # shellcheck disable=SC2086  # words
  unchanged 2 raycreate $words 2>../err
  grep -q '\^' ../err || { echo "no caret for: $words"; cat ../err; exit 1; }
done
for words in 'room 0' 'forest 0'; do
  # shellcheck disable=SC2086  # words
  expect 2 raycreate $words 2>../err
  head -n 1 ../err
done
unchanged 2 raycreate room 1 -o room.xyz 2>/dev/null
