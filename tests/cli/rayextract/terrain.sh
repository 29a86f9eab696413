# The ground of a hillside; what it makes of it does not depend on threads and memory.
raycreate -q terrain 1 --rays 100000 --truth -o hill.ply
rayextract terrain hill.ply | sed 's/ (.*//'
rayextract -q terrain hill.ply --threads 3 --memory 100MB -o other.ply
cmp hill_mesh.ply other.ply
# Of the ends on the true ground most are within 10 cm of the mesh, which has grown no steps at boulders.
raysplit -q hill.ply alpha 0
raysplit -q hill_outside.ply hill_mesh.ply distance 0.1 -o above.ply
raysplit -q above_outside.ply hill_mesh.ply distance -0.1 -o near.ply
rays() { rayinfo "$1" | sed -n 's/^rays  *//p' | tr -d ,; }
[ "$(rays near.ply)" -gt $(($(rays hill_outside.ply) * 3 / 4)) ]
rayextract terrain hill.ply --gradient 0.2 -o flat.ply | sed 's/ (.*//'
