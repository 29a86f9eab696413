# A bend in a file of a transform is applied, starts with their ends; a room that is not bent stays rigid.
raycreate -q room 1 --rays 60000 -o monday.ply
raycreate -q room 1 --rays 60000 --moving 1 -o tuesday.ply
raytranslate -q tuesday.ply 0.1,-0.05,0.02
rayalign tuesday.ply monday.ply --local --nonrigid | grep -E '^bend'
rayalign tuesday.ply monday.ply --local --nonrigid --output_transform t.yaml >/dev/null
! grep bend t.yaml
make_cloud map.ply 50
cat >bend.yaml <<'END'
matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
bend_centre: [0, 0]
bend:
  - [0, 0, 0]
  - [0.5, 0, 0]
  - [0, 0, 0]
END
rayalign -q map.ply --apply bend.yaml -o bent.ply >/dev/null
rayexport -q map.ply before.csv before.txt
rayexport -q bent.ply after.csv after.txt
[ "$(wc -l <before.csv)" = "$(wc -l <after.csv)" ]
! cmp -s before.csv after.csv
for how in '--threads 1' '--threads 8' '--memory 10MB'; do
  rayalign -q map.ply --apply bend.yaml $how -o how.ply >/dev/null
  cmp how.ply bent.ply
done
# A file with half a bend.
grep -v centre bend.yaml >half.yaml
unchanged 1 rayalign map.ply --apply half.yaml
