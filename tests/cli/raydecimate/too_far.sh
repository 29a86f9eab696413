# Cubes that are too small for the cloud: one line, exit 1, nothing left behind.
make_cloud cloud.ply 5
mkdir quiet && cp cloud.ply quiet && cd quiet
for form in '1e-300 m' '1e-300 m 2 points' '1e-300 m/ray' '1e-10 m/ray'; do
  unchanged 1 raydecimate cloud.ply $form 2>../err
  [ "$(wc -l <../err)" = 1 ] || { cat ../err; exit 1; }
done
raydecimate -q cloud.ply 1e12 m && rayinfo cloud_decimated.ply | grep '^rays'
raydecimate -q cloud.ply 1e300 m/ray && rayinfo cloud_decimated.ply | grep '^rays'
