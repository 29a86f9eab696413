# Clouds without much of a ground: points on a line or in a wall have none; three of them, and a plane, have.
cloud_of() {
  local rows=("${@:2}")
  {
    ply_header ${#rows[@]} "${ray_properties[@]}"
    printf '%s 1 0 0 5 9 9 9 200\n' "${rows[@]}"
  } >"$1"
}
line=()
wall=()
plane=()
for i in {0..39}; do
  line+=("$i $i 3")
  wall+=("$((i % 8)) 0 $((i / 8))")
  plane+=("$((i % 8)) $((i / 8)) $((i % 8))")
done
cloud_of line.ply "${line[@]}"
cloud_of wall.ply "${wall[@]}"
cloud_of one_place.ply "1 2 3" "1 2 3" "1 2 3" "1 2 3"
for cloud in line wall one_place; do
  unchanged 1 rayextract terrain $cloud.ply
done
cloud_of three.ply "0 0 1" "4 0 1" "0 3 2"
cloud_of plane.ply "${plane[@]}"
unchanged 1 rayextract terrain three.ply
for gradient in 1 1e12; do
  rayextract -q terrain plane.ply --gradient $gradient -o ground.ply
  echo "gradient $gradient: $(LC_ALL=C sed -n 's/^element face //p' ground.ply) faces"
done
unchanged 1 rayextract terrain plane.ply --gradient 1e-12
