# What does not belong together is refused with the reason, and nothing is written.
binary_cloud cloud.ply 1000
raydecimate -q cloud.ply 10 cm
raydecimate -q cloud.ply 3 rays -o every.ply
binary_cloud other.ply 900
cp cloud_decimated.ply shifted.ply
raytranslate -q shifted.ply 0,0,0,5000
mkdir quiet && mv ./*.ply quiet && cd quiet
unchanged 1 rayrestore cloud_decimated.ply 20 cm cloud.ply
unchanged 1 rayrestore cloud_decimated.ply 10 rays cloud.ply
unchanged 1 rayrestore every.ply 10 cm cloud.ply
unchanged 1 rayrestore cloud_decimated.ply 10 cm other.ply
unchanged 1 rayrestore shifted.ply 10 cm cloud.ply
