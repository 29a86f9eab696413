# Every style from every side, the same for any number of threads, with what its colours mean.
make_cloud cloud.ply 3000
for style in ends mean sum starts rays height; do
  for view in top left right front back; do
    rayrender -q cloud.ply $view $style --resolution 100
    for threads in 1 3 8; do
      rayrender -q cloud.ply $view $style --resolution 100 --threads $threads -o t.png
      cmp t.png cloud_${view}_$style.png
    done
  done
done
for style in sum rays height ends; do
  rayrender cloud.ply front $style --pixel_width 0.05 -o f.png | sed 's/ wrote .*//'
done
