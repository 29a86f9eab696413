# Different columns, types, precision, coordinate systems: all rays, and what was done about it is said.
{
  ply_header 1 "${ray_properties[@]}" 'ushort echo' 'float width'
  echo "1 2 3 10 0 0 1 1 2 3 4 7 0.5"
} | sed '2a comment crs EPSG:32756' >a.ply
{
  ply_header 1 'float x' 'float y' 'float z' 'double time' 'float nx' 'float ny' 'float nz' 'short echo' 'int tree'
  echo "4 5 6 20 0 0 1 -7 9"
} | sed '2a comment crs EPSG:32755' >b.ply
raycombine a.ply b.ply 2>&1 | head -n 5
rayinfo a_combined.ply | grep -i 'precision\|crs' || true
rayexport -q a_combined.ply out.csv - && cat out.csv
{
  ply_header 1 "${ray_properties[@]}" 'double echo__low'
  echo "1 2 3 10 0 0 1 1 2 3 4 7"
} >c.ply
raycombine -q c.ply -o one.ply
rayexport -q one.ply out.csv - && cat out.csv
mkdir quiet && cp a.ply b.ply quiet && cd quiet
unchanged 1 raycombine a.ply b.ply --join 2>../err
cat ../err
unchanged 1 raycombine a.ply missing.ply 2>../err
cat ../err
unchanged 2 raycombine 2>../err
unchanged 2 raycombine all 2>../err
