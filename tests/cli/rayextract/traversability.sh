# The three commands of the paper's section IX-C on a hillside: the ground, the half metre above it, and what
# stands in it.
raycreate -q terrain 2 --rays 200000 -o hill.ply
raydecimate -q hill.ply 4 cm
raywrap hill_decimated.ply upwards 0.1 | sed 's/ (.*//'
raysplit hill_decimated.ply hill_decimated_mesh.ply distance 0.5 | sed 's/ (.*//'
raywrap hill_decimated_outside.ply downwards 2.0 | sed 's/ (.*//'
# The second mesh lies on what is less than half a metre above the first: nothing of it is higher.
raysplit -q hill_decimated_outside.ply hill_decimated_outside_mesh.ply distance 0.000001 -o above.ply
rayinfo above.ply | grep bounded
