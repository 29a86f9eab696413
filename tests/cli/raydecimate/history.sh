# The header remembers the commands without file names; threads, memory and the output's name change no byte.
binary_cloud cloud.ply 1000
raydecimate -q cloud.ply 4 cm -o a.ply
raydecimate -q cloud.ply 4 cm --threads 3 --memory 1GB --output b.ply
cmp a.ply b.ply
raytranslate -q a.ply 1,2,3,4
rayinfo a.ply | grep '^history'
