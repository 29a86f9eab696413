# The distance from the trees of a file.
{
  ply_header 3 "${ray_properties[@]}"
  echo "1 0 2 1 0 0 1 255 0 0 200"
  echo "0.3 0 2 2 0 0 1 0 255 0 0"
  echo "0.45 0 1 3 0 0 1 0 0 255 7"
} >cloud.ply
printf 'x,y,z,radius,parent_id\n0,0,0,0.2,-1, 0,0,5,0.2,0\n' >trees.txt
raysplit -q cloud.ply trees.txt distance 0.2
rayexport -q cloud_outside.ply out.csv - && cut -d, -f1-4 out.csv
mkdir quiet && cp cloud.ply quiet && cd quiet
printf 'nonsense\n' >trees.txt
unchanged 1 raysplit cloud.ply trees.txt distance 0.2 2>../err
cat ../err
unchanged 1 raysplit cloud.ply none.txt distance 0.2 2>../err
cat ../err
