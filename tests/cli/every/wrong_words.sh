# Words and options that no command has are refused with status 2, on standard error only, before anything is read.
for command in $(commands); do
  for words in "--no_such_option" "one two three four five six seven" "--threads" "--threads many" "--memory lots"; do
    [ "$command ${words%% *}" != "raycombine one" ] || continue  # takes any number of files
    # shellcheck disable=SC2086  # words
    expect 2 "$command" $words >out 2>err
    [ ! -s out ] && [ -s err ] || { echo "$command $words: wrong stream"; exit 1; }
  done
done
