# Each form, on rays whose colours can be worked out: time is red, green and blue at 0, 20 and 40 s of each minute,
# height once around in each 10 m.
{
  ply_header 4 "${ray_properties[@]}"
  echo "0 0 0 60.1 0 0 2 9 9 9 40"
  echo "1 0 5 80.1 0 0 2 9 9 9 200"
  echo "2 0 10 100.1 0 0 2 9 9 9 0"
  echo "3 0 -2.5 120.1 0 0 2 9 9 9 255"
} >cloud.ply
for words in time height alpha 'alpha 0.2' 'alpha 0.0001' 'alpha 0' '1,0.5,0'; do
  echo "$words"
  raycolour -q cloud.ply $words
  rayexport -q cloud_coloured.ply out.csv - && tail -n +2 out.csv | cut -d, -f4-
done
