# A board stands before a wall in one scan and not in another; there is nothing but sky beside the wall.
board_scan 0 0 monday.ply first
board_scan 1 86400 tuesday.ply second
raydiff monday.ply tuesday.ply | sed 's/, wrote .*//'
raydiff tuesday.ply monday.ply -o back.ply --distance 20cm | sed 's/, wrote .*//'
# One cloud of both, with the columns of both, or one for each with its own; nothing of a ray is lost.
rayinfo monday_diff.ply | grep -E '^(rays|  bounded|colour|extra column|history)'
mkdir each && cp monday.ply tuesday.ply each && cd each
raydiff monday.ply tuesday.ply --individual | tail -n 1 | sed 's/ ([^)]*)//g; s/ in [0-9.]* s$//'
for day in monday tuesday; do
  rayinfo ${day}_diff.ply | grep -E '^(rays|  bounded|colour|extra column)'
done
rayexport -q monday.ply before.csv -
rayexport -q monday_diff.ply after.csv -
cmp <(cut -d, -f1-4 before.csv) <(cut -d, -f1-4 after.csv)
cd ..
# What was added can be taken out by its colour.
raysplit -q monday_diff.ply single_colour 0,255,127 -o added.ply
rayinfo added.ply | grep -E '^(rays|extra column)'
# More rays are more careful. As JSON, and nothing else; quietly, the table still comes.
raydiff monday.ply tuesday.ply --rays 1000000 --json -o more.ply
raydiff -q monday.ply tuesday.ply -o more.ply
