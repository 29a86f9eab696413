# The example of every usage that reads a file, run where there is none, fails with one line that starts with the command's
# name, and leaves nothing behind.
mkdir empty && cd empty
for command in $(commands); do
  [ "$command" != raycloud ] || continue
  "$command" --help all | sed -n "s/^ *e\.g\. \($command .*\)/\1/p" >../examples
  [ -s ../examples ] || { echo "$command --help shows no example"; exit 1; }
  while read -r example; do
    [[ ! $example =~ ^raycreate\ [a-z]+\ [0-9] ]] || continue  # makes a world out of nothing
    # shellcheck disable=SC2086  # words
    unchanged 1 $example 2>../err
    [ "$(wc -l <../err)" = 1 ] && grep -q "^$command: " ../err || { echo "$example:"; cat ../err; exit 1; }
  done <../examples
done
