# Steps that cut, sort and thin: the bytes of the commands, whichever output goes on, and with a step that reads twice
# behind others.
binary_cloud cloud.ply 20000
pipe_is() {
  raypipe -q cloud.ply "$@" -o piped.ply
  cmp wanted.ply piped.ply
}
raysplit -q cloud.ply range 4 -o a.ply
raycolour -q a.ply time -o b.ply
raysplit -q b.ply plane 1,2,0.5 -o wanted.ply
pipe_is split range 4 : colour time : split plane 1,2,0.5
mv wanted_outside.ply wanted.ply
pipe_is split range 4 : colour time : split plane 1,2,0.5 outside
raydecimate -q a_outside.ply 10 cm -o c.ply
raysplit -q c.ply box 20,1,1 50,2,0.7 -o d.ply
raydecimate -q d_outside.ply 3 rays -o wanted.ply
pipe_is split range 4 outside : decimate 10 cm : split box 20,1,1 50,2,0.7 outside : decimate 3 rays
pipe_is split range 4 outside : decimate 10 cm : split box 20,1,1 50,2,0.7 outside : decimate 3 rays --threads 1
raysplit -q c.ply time 30 % -o wanted.ply
pipe_is split range 4 outside : decimate 10 cm : split time 30 %
raysplit -q wanted.ply gap 0.5 -o e.ply
mv e.ply wanted.ply
pipe_is split range 4 outside : decimate 10 cm : split time 30 % : split gap 0.5
unchanged 2 raypipe cloud.ply split grid 1,1,1 : colour time
# Behind the last step that must see the rays in order: written through, single precision or not, to .ply or .laz.
raycolour -q c.ply time -o f.ply
raysplit -q f.ply plane 1,2,0.5 -o wanted.ply
pipe_is split range 4 outside : decimate 10 cm : colour time : split plane 1,2,0.5
cp wanted.ply g.ply
raytranslate -q g.ply 500000.123,6900000.456,0
raycolour -q g.ply height -o wanted.ply
pipe_is split range 4 outside : decimate 10 cm : colour time : split plane 1,2,0.5 : \
  translate 500000.123,6900000.456,0 : colour height
raycolour -q g.ply height -o wanted.laz
raypipe -q cloud.ply split range 4 outside : decimate 10 cm : colour time : split plane 1,2,0.5 : \
  translate 500000.123,6900000.456,0 : colour height -o piped.laz
cmp wanted.laz piped.laz
raydecimate -q a_outside.ply 10 cm -o h.laz
raypipe -q cloud.ply split range 4 outside : decimate 10 cm -o piped.laz
cmp h.laz piped.laz
