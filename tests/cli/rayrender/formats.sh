# The extension decides the format; .hdr has the real values.
make_cloud cloud.ply 1000
starts_with() { [ "$(head -c "${#2}" "$1" | tr -d '\0')" = "$2" ] || { echo "$1 does not start with $2"; exit 99; }; }
for format in png jpg JPEG bmp tga hdr; do
  rayrender -q cloud.ply top mean --resolution 40 -o "a.$format"
done
starts_with a.bmp BM
starts_with a.hdr '#?RADIANCE'
[ "$(od -An -tx1 -N3 a.jpg | tr -d ' ')" = ffd8ff ]
[ "$(od -An -tx1 -N3 a.JPEG | tr -d ' ')" = ffd8ff ]
[ "$(od -An -tu2 -j12 -N2 a.tga | tr -d ' ')" = 40 ]

# One ray of 5 m in the picture: each byte of the only pixel is 5/8 · 256, and 8 is 2 to the power 131 − 128.
{
  ply_header 1 "${ray_properties[@]}"
  echo 3 4 0 1 -3 -4 0 9 8 7 255
} >one.ply
rayrender -q one.ply top rays --pixel_width 10 -o one.hdr
[ "$(tail -c 4 one.hdr | od -An -tu1)" = ' 160 160 160 131' ]

echo old >a.gif
unchanged 2 rayrender cloud.ply top ends -o a.gif 2>../err
grep -q "a.gif: unknown extension .gif; known are .png .jpg .jpeg .bmp .tga .hdr" ../err
unchanged 2 rayrender cloud.ply top ends -o picture 2>/dev/null
unchanged 1 rayrender cloud.ply top ends -o none/a.jpg
unchanged 1 rayrender cloud.ply top sum --memory 1MB --resolution 10000 -o a.png
unchanged 1 rayrender cloud.ply left ends --pixel_width 0.0002 -o a.bmp
