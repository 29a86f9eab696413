# A picture of the cloud from the top, painted over, falls back onto it; a file that is no image is refused.
binary_cloud cloud.ply 500
raycolour -q cloud.ply height -o high.ply
rayrender -q high.ply top ends -o map.png
raycolour -q cloud.ply image map.png
rayrender -q cloud_coloured.ply top ends -o again.png
cmp map.png again.png
echo "not an image" >text.png
: >empty.png
head -c 100 map.png >cut.png
mkdir quiet && cp cloud.ply ./*.png quiet && cd quiet
for file in text.png empty.png cut.png missing.png; do
  unchanged 1 raycolour cloud.ply image "$file" 2>../err
  grep -q "^raycolour: $file: " ../err && [ "$(wc -l <../err)" = 1 ] || { cat ../err; exit 1; }
done
