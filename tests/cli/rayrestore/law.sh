# Decimating and restoring gives the full cloud back, byte for byte but for the history.
binary_cloud cloud.ply 20000
bytes=$(($(stat -c %s cloud.ply) / 20000))
rows() { tail -c $((20000 * bytes)) "$1"; }
for form in '20 cm' '5 rays'; do
  raydecimate -q cloud.ply $form
  rayrestore -q cloud_decimated.ply $form cloud.ply --threads 3
  cmp <(rows cloud.ply) <(rows cloud_restored.ply)
done
rayinfo cloud_restored.ply | grep '^history'
