# Every command prints its name and the one version.
for command in $(commands); do
  "$command" --version
done >versions
awk 'NF != 2 || $2 !~ /^[0-9]+\.[0-9]+\.[0-9]+$/ { print "odd: " $0; bad = 1 } { seen[$2] = 1 }
  END { for (v in seen) ++n; if (n != 1) print "versions differ"; exit bad || n != 1 }' versions
[ "$(awk '{ print $1 }' versions)" = "$(commands)" ]
