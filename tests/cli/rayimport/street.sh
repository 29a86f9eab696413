# The scan that ships: every point finds its origin, rays without a return are unbounded, and the audit is content.
rayimport "$DATA/street.laz" "$DATA/street_trajectory.txt" -o street.ply >report 2>warnings
[ ! -s warnings ]
rayinfo street.ply --check >info
grep -q 'the sensor positions look right' info
grep -qE '^  unbounded +[1-9]' info
