# The split-combine law on files: the sides of every split have each ray once, and cut rays become whole again.
make_cloud cloud.ply 2000
# Every end with its time, colour and number.
ends() { rayexport -q "$1" dump.csv - && sort dump.csv && rm dump.csv; }
ends cloud.ply >expected

unmarked() { if rayinfo "$1" | grep clipped; then exit 1; fi; }

rejoined() {
  raycombine -q "$@" --join -o again.ply
  ends again.ply | cmp - expected
  unmarked again.ply
  rm again.ply
}
for form in 'plane 1,0,0' 'plane 0,2,0.5' 'box 1,1,1 3,2,2' 'capsule 0,0,0 20,0,0 2'; do
  raysplit -q cloud.ply $form
  rayinfo cloud_inside.ply | grep -q clipped
  rejoined cloud_inside.ply cloud_outside.ply
  rejoined cloud_outside.ply cloud_inside.ply
done
raysplit -q cloud.ply grid 3,3,0 -o cell.ply
[ -e cell_0_0.ply ] && [ -e cell_5_1.ply ]
rejoined cell_*.ply
raysplit -q cloud.ply grid 3,3,3,5 -o cell.laz
[ "$(ls cell_*_*_*_*.laz | wc -l)" -gt 50 ]
raycombine -q cell_*.laz --join -o again.laz
rayinfo again.laz | grep '^rays  *2,000$'

for form in 'range 4' 'raydir 0,0,0.3' 'time 12' 'time 25 %' 'alpha 0' 'alpha 0.5' 'colour 0.5,0,0' 'single_colour 255,255,255' 'gap 0.2'; do
  raysplit -q cloud.ply $form
  unmarked cloud_inside.ply
  raycombine -q cloud_inside.ply cloud_outside.ply
  ends cloud_inside_combined.ply | cmp - expected
done
if ls -A | grep -v '^cloud\|^cell\|^again\|^expected'; then exit 1; fi
