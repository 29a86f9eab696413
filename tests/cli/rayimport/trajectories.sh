# Trajectories as they come: unsorted and duplicated ones give the same cloud as the tidy one, with a note; empty ones,
# ones of another time and ones that are not numbers are refused before anything is written.
make_cloud cloud.ply 200
rayexport -q cloud.ply points.ply trajectory.txt
rayimport -q points.ply trajectory.txt -o expected.ply

{ head -1 trajectory.txt; tail -n +2 trajectory.txt | tac; } >unsorted.txt
rayimport points.ply unsorted.txt -o out.ply >report
grep -qi 'sort' report
rayinfo --json out.ply | grep -v '"file"' >a && rayinfo --json expected.ply | grep -v '"file"' | cmp - a
cmp out.ply expected.ply

{ cat trajectory.txt; tail -n +2 trajectory.txt; } >twice.txt
rayimport points.ply twice.txt -o out.ply >report
cmp out.ply expected.ply

sed -n '1,2p' trajectory.txt >one_node.txt
expect 0 rayimport points.ply one_node.txt -o out.ply >report || true
rm out.ply report a

: >empty.txt
unchanged 1 rayimport points.ply empty.txt
printf '%%time x y z\n' >heading.txt
unchanged 1 rayimport points.ply heading.txt
printf 'hello world\nthis is not a trajectory\n' >words.txt
unchanged 1 rayimport points.ply words.txt
unchanged 1 rayimport points.ply missing.txt
awk '/^[0-9]/ { $1 += 5000 } { print }' trajectory.txt >later.txt
unchanged 1 rayimport points.ply later.txt
awk '/^[0-9]/ { printf "%.0f", $1 * 1e9; $1 = ""; print; next } { print }' trajectory.txt >nanoseconds.txt
unchanged 1 rayimport points.ply nanoseconds.txt
