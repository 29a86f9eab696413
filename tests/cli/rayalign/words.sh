# Words that do not go together, and results that would take the place of the reference.
make_cloud map.ply 200
cp map.ply map_aligned.ply
cp map.ply other.ply
ln -s other.ply link.ply
printf '1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n' >t.txt
for words in '' 'map.ply --local' 'map.ply other.ply --level' 'map.ply other.ply --apply t.txt' \
  'map.ply --apply t.txt --level' 'map.ply map_aligned.ply' 'map.ply other.ply -o link.ply' 'map.ply other.ply map.ply'; do
  unchanged 2 rayalign $words 2>>../err
done
grep '^rayalign: ' ../err | grep -v ': align a'
# A transform of sixteen numbers; the columns stay, and so does what was not moved.
rayalign map.ply --apply t.txt -o moved.ply | sed 's/ ([^)]*)//g; s/ in [0-9.]* s$//'
rayinfo moved.ply | grep -E '^(rays|  bounded|history)'
