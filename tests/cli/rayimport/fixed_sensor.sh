# A fixed sensor, a negative coordinate among them, is a vector and not an option.
printf 'x,y,z,time,intensity\n1,2,3,10,5\n4,5,6,11,0\n' >points.csv
rayimport points.csv -1,-2,0.5
rayexport -q points.ply out.csv path.csv && cat out.csv
