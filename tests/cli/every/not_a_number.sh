# Rows with NaN or infinity in any coordinate are left out, counted and reported; the other rows stay.
make_cloud whole.ply 50
for column in 1 2 3 4 5 6 7; do
  for value in nan inf -inf; do
    awk -v column="$column" -v value="$value" '
      !body { print } body { if (++row == 21) $column = value; print } /end_header/ { body = 1 }' whole.ply >cloud.ply
    awk '!body { print } body { if (++row != 21) print } /end_header/ { body = 1 }' whole.ply |
      sed 's/^element vertex 50/element vertex 49/' >expected.ply
    raycolour cloud.ply 1,1,1 -o out.ply >report
    grep -q '^raycolour: 1 ray with NaN or infinite values left out$' report
    raycolour -q expected.ply 1,1,1 -o wanted.ply
    cmp out.ply wanted.ply
    rayinfo cloud.ply | grep -q 'left out  *1 with NaN'
  done
done
