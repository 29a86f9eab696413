#include "cli/complete.h"

#include <string>
#include <string_view>

namespace ray::cli {
namespace {

/// The script with every COMMAND replaced.
std::string named(std::string_view script, const std::string& command) {
  constexpr std::string_view kPlace = "COMMAND";
  std::string text;
  while (true) {
    const std::size_t place = script.find(kPlace);
    text += script.substr(0, place);
    if (place == std::string_view::npos) return text;
    text += command;
    script.remove_prefix(place + kPlace.size());
  }
}

}  // namespace

std::string bash_completion(const std::string& command) {
  return named(R"bash(# bash completion for COMMAND
_COMMAND() {
  local line extension
  COMPREPLY=()
  while IFS= read -r line; do
    if [[ $line != $'\t'* ]]; then
      COMPREPLY+=("${line%%$'\t'*}")
    elif [[ $line == $'\t' ]]; then
      compopt -o filenames
      mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$2")
    else
      compopt -o filenames
      mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -d -- "$2")
      for extension in $line; do
        mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -X "!*.$extension" -- "$2")
      done
    fi
  done < <("$1" --generate complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -o bashdefault -o default -F _COMMAND COMMAND
)bash",
               command);
}

std::string zsh_completion(const std::string& command) {
  return named(R"zsh(#compdef COMMAND
# zsh completion for COMMAND
_COMMAND() {
  local line
  local -a candidates extensions
  for line in "${(@f)$("${words[1]}" --generate complete "${(@)words[2,CURRENT]}" 2>/dev/null)}"; do
    if [[ $line == $'\t'* ]]; then
      extensions=(${=line})
      if (( $#extensions )); then
        _files -g "*.(${(j:|:)extensions})(-.)"
      else
        _files
      fi
    elif [[ -n $line ]]; then
      candidates+=("${line%%$'\t'*}:${line#*$'\t'}")
    fi
  done
  (( $#candidates )) && _describe COMMAND candidates
}
if [[ $funcstack[1] == _COMMAND ]]; then
  _COMMAND "$@"
else
  compdef _COMMAND COMMAND
fi
)zsh",
               command);
}

std::string fish_completion(const std::string& command) {
  return named(R"fish(# fish completion for COMMAND
function __COMMAND_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    set -l program $words[1]
    set -e words[1]
    for line in ($program --generate complete $words "$current" 2>/dev/null)
        if not string match -q \t'*' -- $line
            echo $line
        else if test $line = \t
            __fish_complete_path "$current"
        else
            for extension in (string split -n ' ' -- (string trim -- $line))
                __fish_complete_suffix .$extension
            end
        end
    end
end
complete -c COMMAND -f -a '(__COMMAND_complete)'
)fish",
               command);
}

}  // namespace ray::cli
