# Which side is which, the cut, its mark, and the notes.
{
  ply_header 3 "${ray_properties[@]}"
  echo "0 0 4 1 0 0 -4 255 0 0 200"
  echo "0 0 1 2 0 0 0 0 255 0 0"
  echo "0 3 2 3 0 0 -1 0 0 255 7"
} >cloud.ply
show() { for cloud in "$@"; do rayexport -q "$cloud" out.csv - && cat out.csv; done; }
raysplit -q cloud.ply plane 0,0,2
show cloud_inside.ply cloud_outside.ply
raysplit -q cloud.ply range 2 -o near.ply
show near.ply near_outside.ply
raysplit cloud.ply alpha 1 | head -n 1
raysplit cloud.ply time 0 | head -n 1
rayinfo cloud_inside.ply | grep '^rays'
raysplit -q cloud.ply colour && ls cloud_[0-9]*.ply && rm cloud_[0-9]*.ply
raysplit -q cloud.ply seg_colour && ls cloud_[0-9]*.ply && rm cloud_[0-9]*.ply
raysplit -q cloud.ply grid 0,2,0,2 && ls cloud_[0-9]*.ply && rm cloud_[0-9]*.ply
rayinfo cloud.ply | grep -c clipped || true
