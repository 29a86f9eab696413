# `raycloud` alone lists every command there is, each on a line with what it does, and exits 0.
raycloud >list 2>err
[ ! -s err ]
for command in $(commands); do
  [ "$command" = raycloud ] || grep -qE "^ *raycloud ${command#ray} +[a-z]" list || { echo "not listed: $command"; exit 1; }
done
