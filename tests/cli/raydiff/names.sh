# No result takes the place of a cloud or of another result.
mkdir month1 month2
make_cloud month1/map.ply 200
make_cloud month2/map.ply 300
wrote() { "$@" | tail -n 1 | sed 's/.*wrote //; s/ ([^)]*)//g; s/ in [0-9.]* s$//'; }
wrote raydiff month1/map.ply month2/map.ply --individual
wrote raydiff month1/map.ply month1/map.ply --individual
wrote raydiff month1/map.ply ./month1/../month1/map.ply
ls month1 month2
cp month1/map.ply map.ply && cp month2/map.ply map_diff.ply && ln -s map.ply other.ply
unchanged 2 raydiff map.ply map_diff.ply 2>../err
unchanged 2 raydiff map_diff.ply map.ply -o map.ply 2>>../err
unchanged 2 raydiff map.ply month2/map.ply -o other.ply 2>>../err
unchanged 2 raydiff map.ply month1/map.ply -o x.ply --individual 2>>../err
grep '^raydiff: ' ../err | grep -v ': what came'
cmp map.ply month1/map.ply
wrote raydiff map.ply map_diff.ply -o new.ply
# Other kinds of files, and both kinds together.
rayexport -q map.ply points.laz path.txt
raydecimate -q map.ply 1 ray -o cloud.laz
wrote raydiff cloud.laz map.ply
wrote raydiff map.ply cloud.laz --individual
rayinfo cloud_diff.laz | grep -E 'difference'
