# Ctrl-C while moving in place: exit 130, the cloud as it was, nothing left behind.
binary_cloud big.ply 400000
mkdir work && cp big.ply work/cloud.ply && cd work
raytranslate cloud.ply 1,2,3 2>../err &
process=$!
until compgen -G '.cloud.ply.*.partial' >/dev/null; do
  kill -0 "$process" 2>/dev/null || skip "the machine was too fast to be interrupted"
done
kill -INT "$process" 2>/dev/null || true
status=0
wait "$process" || status=$?
[ "$status" != 0 ] || skip "the machine was too fast to be interrupted"
[ "$status" = 130 ]
cmp cloud.ply ../big.ply
[ "$(ls -A)" = cloud.ply ]
grep -q '^raytranslate: interrupted' ../err
