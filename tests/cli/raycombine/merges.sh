# A board stands before a wall in one scan and not in another: what each word takes out, and what is said.
board_scan 0 0 monday.ply mine
board_scan 1 86400 tuesday.ply mine
for kind in min max oldest newest order; do
  raycombine $kind monday.ply tuesday.ply 10 rays | sed 's/, wrote .*//'
  rayinfo monday_differences.ply | grep -E '^(rays|time|extra column)'
done
rayinfo monday_combined.ply | grep history
# The other way round `order` takes out others; with --output both names follow; in place there is one file.
raycombine order tuesday.ply monday.ply 10 rays -o merged.ply | grep 'gave way'
ls merged*
cp tuesday.ply week.ply
raycombine order week.ply monday.ply 10 rays -o ./week.ply | sed 's/ (.*//'
ls week*
# The same rays by any number of threads; the order of the files does not matter but for the order of the rays.
for kind in min newest order; do
  raycombine -q $kind monday.ply tuesday.ply 5 rays -o one.ply --threads 1
  for threads in 2 3 8; do
    raycombine -q $kind monday.ply tuesday.ply 5 rays -o more.ply --threads "$threads"
    cmp one.ply more.ply
    cmp one_differences.ply more_differences.ply
  done
done
rows() { rayexport -q "$1" "$1.csv" - && sort "$1.csv"; }
raycombine -q min monday.ply tuesday.ply 10 rays -o one.ply
raycombine -q min tuesday.ply monday.ply 10 rays -o other.ply
cmp <(rows one.ply) <(rows other.ply)
# A cloud and itself, and a third that is only a part: each ray once.
raydecimate -q monday.ply 10 rays
raycombine max monday.ply monday_decimated.ply monday.ply 1 ray | sed 's/, wrote .*//'
