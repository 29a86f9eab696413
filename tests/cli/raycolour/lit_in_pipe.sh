# In a pipe, the bytes of the commands: steps that look around need the whole cloud, before, behind and between others.
binary_cloud cloud.ply 5000
raydecimate -q cloud.ply 10 cm -o a.ply
raycolour -q a.ply shape -o b.ply
raytranslate -q b.ply 1,2,3
raycolour -q b.ply 0.5,0.6,0.7 --lit -o c.ply
raycolour -q c.ply alpha 0.5 -o wanted.ply
for threads in 1 3; do
  raypipe -q cloud.ply decimate 10 cm : colour shape : translate 1,2,3 : colour 0.5,0.6,0.7 --lit : colour alpha 0.5 \
    -o piped.ply --threads "$threads"
  cmp wanted.ply piped.ply
done
raycolour -q cloud.ply branches --lit -o wanted.ply
raypipe -q cloud.ply colour branches --lit -o piped.ply
cmp wanted.ply piped.ply
[ "$(ls -A)" = "$(printf '%s\n' a.ply b.ply c.ply cloud.ply piped.ply wanted.ply)" ]
