# Nothing, one ray, rays that hit nothing, rays that all hit one place.
rows() { ply_header "$1" "${ray_properties[@]}"; for _ in $(seq "$1"); do echo "$2"; done; }
rows 0 '' >none.ply
rows 1 '1 2 3 4 0 0 2 9 9 9 255' >one.ply
rows 5 '1 2 3 4 0 0 2 9 9 9 0' >unbounded.ply
rows 5 '1 2 3 4 0 0 2 9 9 9 255' >identical.ply
for cloud in none one unbounded identical; do
  for words in '4 cm' '3 sigmas' 'range 4 cm'; do
    raydenoise $cloud.ply $words 2>&1 | sed 's/ in [0-9.]* s$//'
  done
done
