# A forest of the trees of a file, which come back with their places and radii, and a walk over the ground of a file.
cat >trees.txt <<'END'
# two trees and a trunk
height,kind, x,y,z,radius,parent_id,section_id
6,1, 0,0,0,0.15,-1,0, 0,0,3,0.1,0,1, 0.5,0,5,0.05,1,1, -0.5,0.2,6,0.02,1,2
5,2, 6,2,0.3,0.12,-1,0, 6,2,3,0.1,0,1, 6.3,2.2,5,0.02,1,1
7,1, -4,5,0.1,0.2,-1,0
END
raycreate -q forest trees.txt --rays 20000 --truth
[ "$(grep -c '^[0-9]' forest_trees.txt)" = 3 ]
rayinfo forest.ply | grep '^rays'
raycreate -q terrain forest_ground.ply --rays 5000 -o walk.ply
rayinfo walk.ply | grep '^rays'
raycreate -q terrain forest_ground.ply --rays 5000 -o again.ply --threads 1
cmp walk.ply again.ply
# An output that would replace its input.
mv forest_ground.ply terrain.ply
unchanged 1 raycreate terrain terrain.ply
mv trees.txt forest_trees.txt
unchanged 1 raycreate forest forest_trees.txt --truth
