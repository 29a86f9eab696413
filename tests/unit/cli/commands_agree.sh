#!/bin/bash
# Every built command has a table without mistakes, a valid manual and completion, and is listed by `raycloud` with the
# summary of its table.
#   commands_agree.sh FOLDER COMMAND...
set -u
bin=$1
shift
wrong=0
complain() {
  echo "$*" >&2
  wrong=1
}
silent() { # silent WHAT PROGRAM...: the program is happy with its standard input, or is not installed
  local what=$1 said
  shift
  command -v "$1" >/dev/null || return 0
  said=$("$@" 2>&1 >/dev/null) && [[ -z $said ]] && return 0
  echo "$what: $said" >&2
  return 1
}

listed=$("$bin/raycloud" --generate complete '') || complain "raycloud cannot list the commands"
for command in "$@"; do
  summary=$("$bin/$command" --generate summary) || complain "$command: no summary"
  "$bin/$command" --generate man | silent "the manual of $command" groff -man -Tutf8 -ww || wrong=1
  for shell in bash zsh fish; do
    "$bin/$command" --generate $shell | silent "the $shell completion of $command" $shell -n /dev/stdin || wrong=1
  done
  "$bin/$command" --generate markdown | grep -q "^# $command: " || complain "$command: no page"
  "$bin/$command" --help >/dev/null || complain "$command --help fails"
  "$bin/$command" --no_such_option >/dev/null 2>&1
  [[ $? == 2 ]] || complain "$command --no_such_option does not exit 2"
  [[ $command == raycloud ]] && continue
  grep -qxF "${summary#ray}" <<<"$listed" || complain "tools/cli/commands.h lacks: $summary"
done
while IFS=$'\t' read -r name _; do
  [[ " $* " == *" ray$name "* ]] || complain "tools/cli/commands.h lists ray$name, which is not built"
done <<<"$listed"
exit $wrong
