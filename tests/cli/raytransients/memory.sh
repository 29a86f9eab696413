# A cloud that does not fit the memory is worked on in blocks: the same bytes, and nothing left in the folder for
# temporary files. Where that is missing, one line says so.
make_cloud cloud.ply 3000
raytransients -q oldest cloud.ply 1 ray -o whole.ply
mkdir temporary
TMPDIR=$PWD/temporary raytransients -q oldest cloud.ply 1 ray --memory 100kB -o blocks.ply
cmp whole.ply blocks.ply
cmp whole_transient.ply blocks_transient.ply
[ -z "$(ls temporary)" ]
mkdir here && cp cloud.ply here && cd here
TMPDIR=/nowhere unchanged 1 raytransients min cloud.ply 1 ray --memory 100kB 2>../err
grep -q '^raytransients: /nowhere: cannot make a temporary file' ../err
