# Help that cannot be written is a failure, not a success.
for command in $(commands); do
  expect 1 "$command" --help >/dev/full 2>/dev/null
  expect 1 "$command" --version >/dev/full 2>/dev/null
done
