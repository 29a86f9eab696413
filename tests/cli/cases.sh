# Finding, running and judging golden cases: shared by run and bless, which set `here` to this folder.

result=$(mktemp -d)  # of the case that ran last: out, err
trap 'rm -rf "$result"' EXIT

# The names TOOL/NAME of the cases asked for. Fails for one that does not exist.
cases() {
  [ $# != 0 ] || set -- '*'
  for wanted in "$@"; do
    case $wanted in
      */*) wanted=$wanted.sh ;;
      *) wanted=$wanted/'*.sh' ;;
    esac
    # shellcheck disable=SC2086  # a pattern
    (cd "$here" && ls -1 $wanted) | sed 's/\.sh$//'
  done
}

# run_case BIN CASE: runs it in a scratch folder; its exit status is ours, its output in $result. The folder above is
# the case's own too: what must not lie among the files it watches goes to ../out and ../err.
run_case() {
  local scratch status=0
  scratch=$(mktemp -d)
  mkdir "$scratch/here"
  (
    cd "$scratch/here"
    export PATH="$1:$PATH" BIN="$1" HOME="$scratch/here" LC_ALL=C TERM=dumb COLUMNS=80
    export CLI="$here" DATA="$here/../data" BASH_ENV="$here/support.sh"
    unset RAYCLOUD_VIEWER
    exec bash -eu -o pipefail "$here/$2.sh"
  ) >"$result/out" 2>"$result/err" </dev/null || status=$?
  rm -rf "$scratch"
  return "$status"
}

# Do the lines of FILE match the patterns of PATTERNS, one for one?
lines_match() {
  local line pattern
  exec 3<"$1" 4<"$2"
  while true; do
    if ! IFS= read -r pattern <&4; then
      ! IFS= read -r line <&3 && return 0
      return 1
    fi
    IFS= read -r line <&3 || return 1
    # shellcheck disable=SC2053  # a pattern
    [[ $line == $pattern ]] || return 1
  done
}

# judge CASE STATUS: prints how the result differs from what was expected; fails if it does.
judge() {
  local expected=$here/$1.sh wanted=0 stream good=0
  [ ! -e "$expected.exit" ] || wanted=$(cat "$expected.exit")
  [ "$2" = "$wanted" ] || { echo "  exit status $2, expected $wanted"; good=1; }
  for stream in out err; do
    if [ -e "$expected.$stream" ]; then
      diff -u --label expected --label "std$stream" "$expected.$stream" "$result/$stream" || good=1
    elif [ -e "$expected.$stream.glob" ] && ! lines_match "$result/$stream" "$expected.$stream.glob"; then
      diff -u --label "expected patterns" --label "std$stream" "$expected.$stream.glob" "$result/$stream" || true
      good=1
    fi
  done
  if [ "$good" != 0 ]; then
    sed 's/^/  out| /' "$result/out" | tail -n 20
    sed 's/^/  err| /' "$result/err" | tail -n 20
  fi
  return "$good"
}
