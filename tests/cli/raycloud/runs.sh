# `raycloud NAME` is rayNAME: its output, its help, and its exit status for each kind of end.
raydecimate --version >expected
raycloud decimate --version | cmp - expected
raycloud raydecimate --version | cmp - expected
raydecimate --help >expected
raycloud decimate --help | cmp - expected
raycloud help decimate | cmp - expected
expect 1 raycloud decimate missing.ply 4 cm 2>err
grep -q '^raydecimate: missing\.ply' err
expect 2 raycloud decimate 2>err
make_cloud cloud.ply
raycloud decimate cloud.ply 10 rays >/dev/null
[ -s cloud_decimated.ply ]
