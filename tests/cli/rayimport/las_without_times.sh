# A LAS file of point format 0 has no times: no trajectory can place its points, a fixed sensor can.
cp "$DATA/untimed.las" points.las
printf '0 0 0 0\n1 1 0 0\n' >trajectory.txt
unchanged 1 rayimport points.las trajectory.txt
rayimport points.las 0,0,1
rayinfo points.ply | grep -q 'made_up'
