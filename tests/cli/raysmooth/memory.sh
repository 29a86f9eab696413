# A cloud that does not fit the memory is worked on in blocks: the same bytes, and nothing left in the folder for
# temporary files. Where that is missing, one line says so.
make_cloud cloud.ply 3000
raysmooth cloud.ply -o whole.ply >summary
grep -q '^raysmooth: .*3,000 rays in' summary || { cat summary; exit 1; }
mkdir temporary
TMPDIR=$PWD/temporary raysmooth -q cloud.ply --memory 50kB -o blocks.ply
cmp whole.ply blocks.ply
[ -z "$(ls temporary)" ]
mkdir here && cp cloud.ply here && cd here
TMPDIR=/nowhere unchanged 1 raysmooth cloud.ply --memory 50kB 2>../err
grep -q '^raysmooth: /nowhere: cannot make a temporary file' ../err
