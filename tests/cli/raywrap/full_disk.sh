# A mesh that does not fit leaves the old one.
raycreate -q room 1 --rays 20000 -o room.ply
small_disk 8
echo old >disk/mesh.ply
unchanged 1 raywrap -q room.ply upwards 100 -o disk/mesh.ply
unchanged 1 rayextract terrain -q room.ply --tolerance 1mm -o disk/mesh.ply
