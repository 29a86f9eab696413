# Columns of every scalar type come out of every command as they went in.
types='char uchar short ushort int uint float double'
{
  ply_header 3 "${ray_properties[@]}" $(for type in $types; do echo "$type extra_$type"; done | tr ' ' '~') | tr '~' ' '
  echo "1 2 3 10 0 0 1 1 2 3 4 -128 0 -32768 0 -2147483648 0 -1.5 -1e300"
  echo "2 2 3 11 0 0 2 1 2 3 4 127 255 32767 65535 2147483647 4294967295 3.25 1e-300"
  echo "3 2 3 12 0 0 3 1 2 3 0 1 2 3 4 5 6 7 8"
} >cloud.ply

# The columns of a file, as text.
columns() { rayexport -q "$1" dump.csv - && sed 's/[^,]*,[^,]*,[^,]*,//' dump.csv | sort && rm dump.csv; }
columns cloud.ply >expected
[ "$(wc -l <expected)" = 4 ]
grep -q extra_uint expected

for out in ply laz las; do
  raydecimate -q cloud.ply 1 cm -o "out.$out"
  columns "out.$out" | cmp - expected
  raydecimate -q cloud.ply 1 ray -o "out.$out"
  columns "out.$out" | cmp - expected
  raysmooth -q cloud.ply -o "smooth.$out"
  columns "smooth.$out" | cmp - expected
  for form in 'range 1.5' 'plane 0,0,3.5'; do
    raysplit -q cloud.ply $form -o "side.$out"
    raycombine -q "side.$out" "side_outside.$out" -o all.ply
    [ "$form" = 'range 1.5' ] || raycombine -q "side.$out" "side_outside.$out" --join -o all.ply
    columns all.ply | cmp - expected
  done
  raytranslate -q "out.$out" 1,2,3
  rayrotate -q "out.$out" 10,20,30
  columns "out.$out" | cmp - expected
  rayexport -q "out.$out" points.ply -
  rayimport -q points.ply 0,0,0 -o again.ply
  columns again.ply | cmp - expected
  rayexport -q "out.$out" points.laz -
  rayimport -q points.laz 0,0,0 -o again.ply
  columns again.ply >got
  grep -o 'extra_[a-z]*' got | sort >names
  grep -o 'extra_[a-z]*' expected | sort | cmp - names
done
