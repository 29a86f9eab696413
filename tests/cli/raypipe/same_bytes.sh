# A pipe gives, byte for byte, what its commands give one after the other: also where single precision turns double on
# the way, where a step reads twice, and for any number of threads.
binary_cloud cloud.ply 5000
raycolour -q cloud.ply height -o high.ply
rayrender -q high.ply top ends -o map.png

raycolour -q cloud.ply time -o a.ply
raytranslate -q a.ply 1.1,2.2,3.3
rayrotate -q a.ply 10,20,30
raycolour -q a.ply image map.png -o b.ply
raytranslate -q b.ply 500000.123,6900000.456,0,7
raycolour -q b.ply alpha 0.5 -o c.ply
for threads in 1 2 8; do
  raypipe cloud.ply colour time : translate 1.1,2.2,3.3 : rotate 10,20,30 : colour image map.png : \
    translate 500000.123,6900000.456,0,7 : colour alpha 0.5 -o piped.ply --threads "$threads" -q
  cmp c.ply piped.ply
done

# Steps that change nothing leave nothing behind; one that is left behaves as alone.
raypipe -q cloud.ply translate 0,0,0 : colour time : rotate 0,0,0
raycolour -q cloud.ply time
cmp cloud_pipe.ply cloud_coloured.ply
raycloud pipe cloud.ply colour time -q --output other.ply
cmp other.ply cloud_pipe.ply

# No file remains but those that were asked for.
[ "$(ls -A)" = "$(printf '%s\n' a.ply b.ply c.ply cloud.ply cloud_coloured.ply cloud_pipe.ply high.ply map.png other.ply piped.ply)" ]
