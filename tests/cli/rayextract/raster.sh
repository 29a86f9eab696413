# The ground, the tops and what is between them as GeoTIFF, in the coordinate system of the cloud.
raycreate -q terrain 1 --rays 20000 -o hill.ply
LC_ALL=C sed -i '0,/^comment/s/^comment/comment crs EPSG:32633\ncomment/' hill.ply
rayinfo hill.ply | grep crs
rayextract terrain hill.ply --raster 2 --canopy | sed 's/ ([^)]*)//g; s/ in [0-9.]* s$//'
cp hill_dtm.tif dtm.tif
rayextract -q terrain hill.ply --raster 2 --threads 3
cmp dtm.tif hill_dtm.tif
rayextract -q terrain hill.ply --raster 2 -o ground.ply
cmp dtm.tif ground_dtm.tif
for raster in dtm dsm chm; do
  [ "$(head -c 4 hill_$raster.tif | od -An -tx1)" = ' 49 49 2a 00' ]
  # The key of a projected system with the code, whole as GeoTIFF has it.
  od -An -v -tu2 -w2 hill_$raster.tif | tr -s ' \n' '  ' | grep -c ' 3072 0 1 32633 '
done
if command -v gdalinfo >/dev/null; then
  gdalinfo -stats hill_chm.tif >../info
  grep -q 'ID\["EPSG",32633\]' ../info || grep -q 32633 ../info
  grep -q 'NoData Value=-9999' ../info
  grep -q 'STATISTICS_MINIMUM=0' ../info
fi
rm -f hill_chm.tif.aux.xml
# What makes no sense, or does not fit, writes nothing.
unchanged 2 rayextract terrain hill.ply --canopy 2>../err
head -n 1 ../err
unchanged 2 rayextract terrain hill.ply --raster 0 2>../err
head -n 1 ../err
unchanged 1 rayextract terrain hill.ply --raster 0.0001
