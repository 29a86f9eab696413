# A command that does not exist: what is wrong, a caret, the nearest name; status 2.
expect 2 raycloud decimat cloud.ply 4 cm >out 2>err
[ ! -s out ]
grep -q 'no command decimat.*decimate' err
grep -q '\^~~~' err
expect 2 raycloud ../raydecimate 2>/dev/null
expect 2 raycloud '' 2>/dev/null
expect 2 raycloud raycloud 2>/dev/null
# `git` is one, with other words.
expect 2 raycloud git instal 2>err
grep -q '^raycloud: git wants to be told one thing: install or uninstall' err
