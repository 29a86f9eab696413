# What the user sees.
make_cloud cloud.ply 3
expect 2 raydecimate cloud.ply 4 km
