# One clear line, and nothing is overwritten.
echo kept >room.ply
echo kept >forest.ply
echo kept >terrain.ply
: >empty.txt
printf 'x,y,z,radius\n' >treeless.txt
printf 'x,y,z,radius\n1,2,3,oak\n' >words.txt
printf 'x,y,z,radius,parent_id\n1,2,3,0.1,-1,1,2\n' >cut.txt
: >empty.ply
printf 'v 0 0 0\n' >faceless.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n' >index.obj
make_cloud cloud.ply 10
for words in 'forest missing.txt' 'forest empty.txt' 'forest treeless.txt' 'forest words.txt' 'forest cut.txt' \
  'terrain missing.ply' 'terrain empty.ply' 'terrain faceless.obj' 'terrain index.obj' 'terrain cloud.ply'; do
  # shellcheck disable=SC2086  # words
  unchanged 1 raycreate $words
done
