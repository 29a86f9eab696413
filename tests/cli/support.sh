# Functions for golden cases; in every case without asking.

# The case cannot run here: skip "why".
skip() {
  echo "$*"
  exit 77
}

# expect STATUS COMMAND…: the command must exit with STATUS. Its output passes through.
expect() {
  local wanted=$1 status=0
  shift
  "$@" || status=$?
  [ "$status" = "$wanted" ] && return
  echo "expected exit status $wanted, got $status from: $*" >&2
  exit 99
}

# Names, modes, sizes, times of change and contents of everything in this folder.
folder_state() {
  find . -type d -printf '%P/ %m\n' | sort
  find . ! -type d -printf '%P %y %m %s %T@\n' | sort
  find . -type f -print0 | sort -z | xargs -0r sha256sum
}

# unchanged STATUS COMMAND…: as expect, and no file in this folder may have been added, removed or altered.
unchanged() {
  local before after
  before=$(folder_state)
  expect "$@"
  after=$(folder_state)
  [ "$before" = "$after" ] && return
  echo "the folder changed under: $*" >&2
  diff <(echo "$before") <(echo "$after") >&2 || true
  exit 99
}

# ply_header ROWS PROPERTY…: an ascii header; a PROPERTY is "float x".
ply_header() {
  printf 'ply\nformat ascii 1.0\nelement vertex %d\n' "$1"
  shift
  printf 'property %s\n' "$@"
  echo end_header
}

ray_properties=('double x' 'double y' 'double z' 'double time' 'double nx' 'double ny' 'double nz'
  'uchar red' 'uchar green' 'uchar blue' 'uchar alpha')

# make_cloud FILE [ROWS]: an ascii ray cloud. A sensor walks along x at 1 m/s and 1.5 m height, 100 rays a second,
# and looks round at a floor and a wall 5 m away; every tenth ray is unbounded. The same rows every time.
make_cloud() {
  local rows=${2:-100}
  {
    ply_header "$rows" "${ray_properties[@]}"
    awk -v rows="$rows" 'BEGIN {
      for (i = 0; i < rows; ++i) {
        time = i / 100
        angle = i * 2.399963
        if (i % 2) { dx = 4 * cos(angle); dy = 4 * sin(angle); dz = -1.5 }
        else { dx = 3 * cos(angle); dy = 5; dz = 2 * sin(angle) }
        printf "%.4f %.4f %.4f %.6f %.4f %.4f %.4f %d %d %d %d\n", time + dx, dy, 1.5 + dz, 1000 + time,
          -dx, -dy, -dz, i % 256, (7 * i) % 256, (13 * i) % 256, i % 10 == 9 ? 0 : 100 + i % 100
      }
    }'
  } >"$1"
}

# small_disk KILOBYTES: a file system of that size at ./disk, for as long as the case runs. Skips the case where
# mounting is not allowed.
small_disk() {
  mkdir disk
  mount -t tmpfs -o "size=${1}k" tmpfs disk 2>/dev/null || skip "a small disk cannot be mounted here"
  small_disk_at=$PWD/disk
  trap 'cd / && umount "$small_disk_at"' EXIT
}

# unwritable_folder NAME: a folder in which nobody may create a file. Skips the case where the user may anyway (root).
unwritable_folder() {
  mkdir "$1"
  chmod a-w "$1"
  ! touch "$1/probe" 2>/dev/null || skip "this user may write to every folder"
}

# kill_once PATTERN COMMAND…: runs the command and kills it with signal 9 as soon as a file of this folder matches
# PATTERN. Fails if the command ended before that.
kill_once() {
  local pattern=$1 process
  shift
  "$@" &
  process=$!
  until compgen -G "$pattern" >/dev/null; do
    kill -0 "$process" 2>/dev/null || { echo "ended before it could be killed: $*" >&2; return 1; }
  done
  kill -KILL "$process" 2>/dev/null || true
  wait "$process" 2>/dev/null
  [ $? = 137 ] || { echo "ended before it could be killed: $*" >&2; return 1; }
}

# The commands there are, by name.
commands() { (cd "$BIN" && ls -1 ray* | grep -xE 'ray[a-z]+'); }

# The commands that read a ray cloud, each with words that are right: cloud_commands FILE prints one a line.
cloud_commands() {
  cat <<END
rayexport $1 out.ply out.txt
rayinfo $1
rayinfo $1 --check
rayinfo $1 --json
raytranslate $1 1,2,3
rayrotate $1 0,0,90
raydecimate $1 10 cm
raydecimate $1 10 rays
raydecimate $1 10 cm 3 points
raydecimate $1 10 cm/ray
raydecimate $1 3 cm/m
raydenoise $1 10 cm
raydenoise $1 range 10 cm
raytransients min $1 10 rays
raytransients newest $1 10 rays --paper
rayrestore $1 10 cm $1
raysplit $1 plane 0,0,1
raysplit $1 time 3 %
raysplit $1 gap 1
raysplit $1 colour
raysplit $1 grid 1,1,1
raycombine $1 $1
raycombine $1 --join
raycombine min $1 $1 10 rays
raycombine newest $1 $1 10 rays --paper
raydiff $1 $1
raydiff $1 $1 --json --individual
rayalign $1
rayalign $1 --level
rayalign $1 $1
rayalign $1 $1 --local
raycolour $1 time
raycolour $1 alpha 0.5
raycolour $1 normal --lit
raypipe $1 colour height : translate 1,2,3
raysmooth $1
raypipe $1 smooth : colour time
rayrender $1 top ends
raywrap $1 upwards 0.1
raywrap $1 inwards 0
rayextract terrain $1
END
}

# refused FILE PATTERN: every command that reads a cloud exits 1 with one line that has the command's name and the
# pattern, and changes nothing.
refused() {
  local command
  while read -r command; do
    # shellcheck disable=SC2086  # words
    (unchanged 1 $command) >../out 2>../err || { echo "$command:"; cat ../out ../err; exit 1; }
    if [ -s ../out ] || [ "$(wc -l <../err)" != 1 ] || ! grep -q "^${command%% *}: " ../err ||
      ! grep -qE -- "$2" ../err; then
      echo "$command: wanted one line with: $2; got:"
      cat ../out ../err
      exit 1
    fi
  done < <(cloud_commands "$1")
}

# binary_cloud FILE ROWS: a canonical binary cloud of ROWS rays, 36 bytes each.
binary_cloud() {
  make_cloud "$1.ascii.ply" "$2"
  raydecimate -q "$1.ascii.ply" 1 ray -o "$1"
  rm "$1.ascii.ply"
}

# make_ground FILE: an ascii mesh, 20 m by 20 m around the origin, two triangles that rise by 1 m in 10 towards +x.
make_ground() {
  {
    printf 'ply\nformat ascii 1.0\nelement vertex 4\n'
    printf 'property double %s\n' x y z
    printf 'element face 2\nproperty list uchar int vertex_indices\nend_header\n'
    printf '%s\n' '-10 -10 -1' '10 -10 1' '10 10 1' '-10 10 -1' '3 0 1 2' '3 0 2 3'
  } >"$1"
}

# bad_meshes: in this folder, files that are no mesh that one could use, each named after what is wrong with it.
bad_meshes() {
  make_ground ground.ply
  sed 's/^3 0 1 2$/3 0 1 9/' ground.ply >index.ply
  sed 's/^10 10 1$/10 nan 1/' ground.ply >nan.ply
  sed 's/^3 0 1 2$/3 0 1 1/; s/^3 0 2 3$/3 3 2 3/' ground.ply >no_area.ply
  sed 's/^element face 2/element face 0/; /^3 /d' ground.ply >no_faces.ply
  head -n 12 ground.ply >cut.ply
  : >empty.ply
  printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n' >index.obj
  rm ground.ply
}

# board_scan BOARD BEGIN FILE COLUMN: 10 000 rays in 25 s from BEGIN on, at a wall and, if BOARD is 1, at a board before
# it, which COLUMN tells; every fiftieth ray is unbounded.
board_scan() {
  {
    ply_header 10000 "${ray_properties[@]}" "uchar $4"
    awk -v board="$1" -v begin="$2" 'BEGIN {
      for (i = 0; i < 10000; ++i) {
        x = -2 + 4 * ((i + begin) * 0.754877666 % 1)
        z = 3 * ((i + begin) * 0.569840291 % 1)
        on = board && x > -1 && x < 1 && z > 1 && z < 2
        y = on ? 4 : 8
        printf "%.4f %.4f %.4f %.4f %.4f %.4f %.4f 90 60 30 %d %d\n", x * y / 8, y, z * y / 8, begin + i / 400,
          -x * y / 8, -y, -z * y / 8, i % 50 == 49 ? 0 : 255, on
      }
    }'
  } >"$3"
}
