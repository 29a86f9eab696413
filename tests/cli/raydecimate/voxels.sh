# One ray, the first in the file, for each cube, negative coordinates included.
{
  ply_header 6 "${ray_properties[@]}"
  echo "0.01 0.01 0.01 1 0 0 2 255 0 0 255"
  echo "0.09 0.09 0.09 2 0 0 2 0 255 0 255"
  echo "-0.01 0.01 0.01 3 0 0 2 0 0 255 255"
  echo "-0.09 0.09 0.01 4 0 0 2 0 0 255 255"
  echo "0.11 0.01 0.01 5 0 0 2 0 0 255 0"
  echo "500000.05 6900000.05 -0.05 6 0 0 2 0 0 255 255"
} >cloud.ply
for width in '10 cm' '100 mm' '0.1 m' '10cm'; do
  raydecimate -q cloud.ply $width
  rayexport -q cloud_decimated.ply out.csv - && cut -d, -f4 out.csv | tr '\n' ' '
  echo
done
