# What is not a whole ray cloud is refused by every command in one line, and nothing on the disk changes.
mkdir work && cd work
refused missing.ply 'missing.ply: '

: >empty.ply
refused empty.ply 'empty.ply: '
rm empty.ply

head -c 5000 /dev/urandom >garbage.ply
refused garbage.ply 'garbage.ply: '
rm garbage.ply

mkdir folder.ply
refused folder.ply 'folder.ply: '
rmdir folder.ply

binary_cloud cloud.ply 100
size=$(stat -c %s cloud.ply)
header=$(grep -abo end_header cloud.ply | cut -d: -f1)
header=$((header + 11))
row=$(((size - header) / 100))

head -c 60 cloud.ply >cut.ply
refused cut.ply 'cut.ply: .*header'
head -c $((header + 41 * row + 7)) cloud.ply >cut.ply
refused cut.ply 'cut.ply: truncated at ray 42 of 100'
head -c $((size - 1)) cloud.ply >cut.ply
refused cut.ply 'cut.ply: truncated at ray 100 of 100'
rm cut.ply

# A count that is wrong: one more and one less than there are.
sed 's/^\(element vertex\) .*/\1 101/' cloud.ply >count.ply
refused count.ply 'count.ply: truncated at ray 101 of 101'
sed 's/^\(element vertex\) .*/\1 99/' cloud.ply >count.ply
refused count.ply 'count.ply: .*bytes more|count.ply: .*more bytes'
sed 's/^\(element vertex\) .*/\1 999999999999999999/' cloud.ply >count.ply
refused count.ply 'count.ply: '
sed 's/^\(element vertex\) .*/\1 -5/' cloud.ply >count.ply
refused count.ply 'count.ply: '
rm count.ply

{
  ply_header 3 'float x' 'float y' 'float z' | sed '$d'
  printf 'element face 1\nproperty list uchar int vertex_indices\nend_header\n'
  printf '0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n'
} >mesh.ply
refused mesh.ply 'mesh.ply: .*mesh'
rm mesh.ply

{
  ply_header 2 'float x' 'float y' 'float z' 'double time'
  printf '0 0 0 1\n1 0 0 2\n'
} >points.ply
refused points.ply 'points.ply: .*rayimport'

{
  ply_header 100 'float x' 'float y' 'float z' 'double time' 'float nx' 'float ny' 'float nz'
  awk 'BEGIN { for (i = 0; i < 100; ++i) print i, 2 * i, 3, i, sin(i), cos(i), 0 }'
} >points.ply
refused points.ply 'points.ply: .*normals'
rm points.ply

printf 'x y z\n1 2 3\n' >cloud.xyz
refused cloud.xyz 'cloud.xyz: '
