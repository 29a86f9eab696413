# Killed while moving in place: the cloud is as it was, and moving it again works.
binary_cloud big.ply 400000
cp big.ply cloud.ply
kill_once '.cloud.ply.*.partial' raytranslate cloud.ply 1,2,3 || skip "the machine was too fast to be interrupted"
cmp cloud.ply big.ply
raytranslate -q cloud.ply 1,2,3
rayinfo cloud.ply >/dev/null
