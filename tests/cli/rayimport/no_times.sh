# Points without times need no trajectory but cannot follow one.
printf 'x y z\n1 2 3\n4 5 6\n' >points.xyz
printf '0 0 0 0\n1 1 0 0\n' >trajectory.txt
unchanged 1 rayimport points.xyz trajectory.txt
rayimport -q points.xyz 0,0,1
rayinfo points.ply | grep -q 'made_up'
rayimport -q points.xyz ray 0,0,-10 -o aerial.ply
rayinfo aerial.ply | grep -qE '^sensor .*z 13.000 to 16.000'
