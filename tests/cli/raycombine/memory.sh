# Clouds that do not fit the memory are worked on in 32 blocks: the same bytes, and nothing
# left in the folder for temporary files. Where that is missing, one line says so.
board_scan 0 0 monday.ply mine
board_scan 1 86400 tuesday.ply mine
raydecimate -q tuesday.ply 3 rays -o wednesday.ply
mkdir temporary
blocks() {
  raycombine -q "$@" -o whole.ply
  TMPDIR=$PWD/temporary raycombine -q "$@" -o blocks.ply --memory 100kB --threads 3
  cmp whole.ply blocks.ply
  cmp whole_differences.ply blocks_differences.ply
  rayinfo whole_differences.ply | grep '^rays'
  [ -z "$(ls temporary)" ]
}
for kind in min oldest order; do
  blocks $kind monday.ply tuesday.ply 5 rays
done
blocks newest tuesday.ply monday.ply wednesday.ply 5 rays
blocks max monday.ply tuesday.ply 5 rays --paper
blocks wednesday.ply min monday.ply tuesday.ply 5 rays
mkdir here && cp monday.ply tuesday.ply here && cd here
TMPDIR=/nowhere unchanged 1 raycombine min monday.ply tuesday.ply 5 rays --memory 100kB 2>../err
grep -q '^raycombine: /nowhere: cannot make a temporary file' ../err
