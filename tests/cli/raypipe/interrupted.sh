# Killed or interrupted, a pipe leaves what was there.
binary_cloud cloud.ply 200000
cp cloud.ply before.ply
echo old >out.ply
raypipe -q cloud.ply colour time : rotate 1,2,3 : translate 5,5,5 : colour height -o out.ply &
process=$!
sleep 0.02
kill -INT "$process" 2>/dev/null || true
status=0
wait "$process" || status=$?
if [ "$status" = 0 ]; then
  [ "$(head -c 3 out.ply)" = ply ]  # it was faster
else
  [ "$status" = 130 ] && [ "$(cat out.ply)" = old ]
  [ "$(ls -A)" = "$(printf '%s\n' before.ply cloud.ply out.ply)" ]
fi
cmp cloud.ply before.ply
