# What goes wrong in a step ends the whole pipe in one line, and nothing is left.
binary_cloud cloud.ply 5000
printf 'not an image' >text.png
unchanged 1 raypipe cloud.ply colour time : colour image text.png -o out.ply
unchanged 1 raypipe cloud.ply colour time : translate 1e308,0,0 : translate 1e308,0,0 : colour height
unchanged 1 raypipe cloud.ply colour time -o nowhere/out.ply
unchanged 1 raypipe missing.ply colour time
