# git merges maps: two people edit one in branches of a real repository.
command -v git >/dev/null || skip "git is not installed"
export HOME=$PWD/home XDG_CONFIG_HOME=$PWD/home/.config GIT_CONFIG_NOSYSTEM=1
unset GIT_CONFIG_GLOBAL GIT_DIR GIT_WORK_TREE
mkdir home
rows() { rayexport -q "$1" "$PWD/../$2.csv" - && sort "$PWD/../$2.csv"; }
# What git is told, once however often; what is there stays.
mkdir -p home/.config/git
printf '*.txt text' >home/.config/git/attributes
for i in 1 2; do raycloud git install; done | sed "s:$PWD::"
cat home/.config/git/attributes
git config --global --get-all merge.plymerge.driver
git config --global user.name Nobody
git config --global user.email nobody@example.com
# A map, and two people who change it.
binary_cloud map.ply 300
git init -q maps && cp map.ply maps && cd maps && git symbolic-ref HEAD refs/heads/main
git add map.ply && git commit -qm 'the map'
git checkout -qb mine
raysplit -q map.ply time 1001
mv map_inside.ply map.ply && rm map_outside.ply
git commit -qam 'what came later is gone'
git checkout -q main && git checkout -qb yours
raysplit -q map.ply alpha 0
raycolour -q map_inside.ply 1,0,0 -o red.ply
raycombine -q map_outside.ply red.ply -o map.ply && rm red.ply map_inside.ply map_outside.ply
git commit -qam 'the sky is red'
git checkout -q mine
git merge -q yours -m 'both' | grep '^raycombine' | sed 's/, wrote .*//'
git status --short
ls
git log --oneline | wc -l
raysplit -q map.ply time 1001  # all of mine, but for the red ones
cmp <(git show yours:map.ply >../yours.ply && cd .. && raysplit -q yours.ply time 1001 && cd maps && rows ../yours_inside.ply a) <(rows map_inside.ply b)
rm map_inside.ply map_outside.ply
# Two maps of one name that have nothing in common.
git checkout -q main && git checkout -qb left
make_cloud new.ply 10 && git add new.ply && git commit -qm new
git checkout -q main && git checkout -qb right
make_cloud new.ply 20 && git add new.ply && git commit -qm other
git merge -q left -m 'both new' | grep '^raycombine' | sed 's/, wrote .*//'
git status --short
rayinfo new.ply | grep '^rays'
# What is no cloud stays a conflict, with the file as it was.
git checkout -q main && git checkout -qb broken
echo 'no cloud' >map.ply && git commit -qam broken
git checkout -q mine
git merge broken -m no >../out 2>../err && exit 1
grep -h '^raycombine' ../out ../err | sed 's/merge_file_[A-Za-z0-9]*/merge_file/'
git status --short
git merge --abort
# For the repository alone, and out again.
cd ..
raycloud git uninstall | sed "s:$PWD::"
cat home/.config/git/attributes
git config --global --get-regexp '^merge' && exit 1
raycloud git uninstall -q
cd maps
raycloud git install --repository
cat .git/info/attributes | tail -n 1
git config --local --get merge.plymerge.name
git status --short
git merge -q broken -m no >../out 2>../err && exit 1
git merge --abort
raycloud git uninstall --repository
git config --local --get-regexp '^merge.plymerge' && exit 1
# Where raycombine is not in PATH, the one beside this program is taken; outside of a repository nothing is done.
mkdir -p ../tools && ln -s "$(command -v git)" ../tools/git
bin=$(dirname "$(command -v raycloud)")
PATH=$PWD/../tools "$bin/raycloud" git install --repository -q
[ "$(git config --local --get merge.plymerge.driver)" = "$bin/raycombine %O all %A %B -o %A" ]
cd ..
export GIT_CEILING_DIRECTORIES=$PWD
unchanged 1 raycloud git install --repository
unchanged 2 raycloud git 2>/dev/null
unchanged 2 raycloud git merge 2>/dev/null
