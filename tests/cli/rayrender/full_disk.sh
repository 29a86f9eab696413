# A picture that does not fit leaves the old one.
make_cloud cloud.ply 3000
small_disk 8
for format in png jpg bmp tga hdr; do
  echo old >"disk/a.$format"
  unchanged 1 rayrender -q cloud.ply top mean --resolution 1500 -o "disk/a.$format" 2>../err
  grep -q "^rayrender: disk/a.$format: cannot write: " ../err
  rm "disk/a.$format"
done
