# The result may replace one of its inputs, and a cloud may come twice.
binary_cloud a.ply 50
raycombine -q a.ply a.ply -o a.ply
rayinfo a.ply | grep '^rays  *100$'
