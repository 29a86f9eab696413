# Without arguments every command prints what is wrong and its help on standard error and exits 2; nothing is
# written. `raycloud` lists the commands instead.
mkdir empty && cd empty
for command in $(commands); do
  [ "$command" != raycloud ] || continue
  unchanged 2 "$command" 2>/dev/null
  status=0
  "$command" >/dev/full 2>../err || status=$?
  [ -s ../err ] || { echo "$command says nothing"; exit 1; }
done
