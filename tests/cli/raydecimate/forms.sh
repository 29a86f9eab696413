# Every form: few points in each cube, rays that cross something new, spacing by range.
{
  ply_header 6 "${ray_properties[@]}"
  echo "5.55 0.05 0.05 1 -5 0 0 255 0 0 255"
  echo "5.56 0.05 0.05 2 -5 0 0 255 0 0 255"
  echo "5.57 0.05 0.05 3 -5 0 0 255 0 0 255"
  echo "3.05 0.05 0.05 4 -2.5 0 0 255 0 0 255"
  echo "5.58 0.05 0.05 5 -0.5 0 0 255 0 0 0"
  echo "5.95 0.05 0.05 6 -5.4 0 0 255 0 0 255"
} >cloud.ply
for form in '10 cm 2 points' '100 mm 100 points' '10 cm/ray' '0.1 m/ray' '3 cm/m' '30 mm/m' '20 rays'; do
  raydecimate -q cloud.ply $form
  rayexport -q cloud_decimated.ply out.csv - && echo "$form: $(cut -d, -f4 out.csv | tr '\n' ' ')"
done
