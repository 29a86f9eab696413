# Clouds in which nothing can be told to come or go.
rows() { ply_header "$1" "${ray_properties[@]}"; for i in $(seq "$1"); do echo "${2//TIME/$i}"; done; }
rows 0 '' >none.ply
rows 1 '1 2 3 TIME 0 0 2 9 9 9 255' >one.ply
rows 5 '1 2 3 TIME 0 0 2 9 9 9 0' >unbounded.ply
rows 5 '1 2 3 TIME 0 0 2 9 9 9 255' >one_place.ply
rows 5 '1 2 3 7 0 0 2 9 9 9 255' >one_time.ply
for cloud in none one unbounded one_place; do
  raytransients min $cloud.ply 10 rays | sed 's/ in [0-9.]* s$//'
done
unchanged 1 raytransients min one_time.ply 10 rays
without_times() {
  ply_header 5 "${ray_properties[@]/*time/}" | sed '/^property $/d'
  for i in 1 2 3 4 5; do echo "$i 2 3 0 0 2 9 9 9 255"; done
}
without_times >no_times.ply
unchanged 1 raytransients min no_times.ply 10 rays
{
  ply_header 1 "${ray_properties[@]}" 'double hits'
  echo '1 2 3 4 0 0 2 9 9 9 255 0.5'
} >taken.ply
unchanged 1 raytransients min taken.ply 10 rays
