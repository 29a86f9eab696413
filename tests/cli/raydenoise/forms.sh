# Each form on rays whose noise can be seen: what stays, by its x, and what is said.
{
  ply_header 8 "${ray_properties[@]}" 'ushort ring' 'double mine'
  echo "10 0 0 1 0 0 5 9 9 9 255 0 0.1"
  echo "10.03 0 0 2 0 0 5 9 9 9 255 0 0.2"
  echo "20 0 0 3 0 0 5 9 9 9 0 0 0.3"
  echo "30 0 0 4 0 0 5 9 9 9 255 1 0.4"
  echo "40 0 0 5 0 0 5 9 9 9 255 1 0.5"
  echo "40 0.04 0 6 0 0 5 9 9 9 255 1 0.6"
  echo "40 0.04 0 6 0 0 5 9 9 9 1 1 0.7"
  echo "nan 0 0 7 0 0 5 9 9 9 255 1 0.8"
} >cloud.ply
show() {
  raydenoise "$@" | sed 's/ in [0-9.]* s$//'
  rayexport -q cloud_denoised.ply out.csv - && tail -n +2 out.csv | cut -d, -f1-4,8-
}
show cloud.ply 4 cm
show cloud.ply 39mm
show cloud.ply 0.04 m --min_neighbours 2
show cloud.ply 20 m
show cloud.ply range 4 cm
