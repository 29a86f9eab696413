# Every command answers --help and -h on standard output and exits 0; --help all says no less.
for command in $(commands); do
  "$command" --help >help 2>err
  [ -s help ] && [ ! -s err ] || { echo "$command --help: nothing on stdout, or something on stderr"; exit 1; }
  grep -q "$command" help || { echo "$command --help does not name the command"; exit 1; }
  "$command" -h | cmp - help
  "$command" --help all >all
  [ "$(wc -l <all)" -ge "$(wc -l <help)" ] || { echo "$command --help all is shorter"; exit 1; }
  [ "$(awk '{ if (length > n) n = length } END { print n + 0 }' help)" -le 110 ] || { echo "$command --help is too wide"; exit 1; }
done
