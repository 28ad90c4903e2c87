# SPDX-License-Identifier: GPL-3.0-or-later
# Completion of bash for krater. What there is to complete is asked of the program, so that it cannot be out of date.

_krater_options() { "$1" ${2:+"$2"} --help 2>/dev/null | grep -oE -- '(^|[ ,])--?[a-z][a-z-]*' | tr -d ' ,'; }
_krater_commands() { "$1" --help 2>/dev/null | sed -n '/^Subcommands:/,$ s/^  \([a-z]\+\) .*/\1/p'; }

_krater() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} program=${COMP_WORDS[0]} command="" words=""
  ((COMP_CWORD > 1)) && command=${COMP_WORDS[1]}
  COMPREPLY=()
  if [[ $before == --restart || $before == -o || $before == --output ]]; then
    compopt -o default
  elif [[ $word == -* ]]; then
    words=$(_krater_options "$program" "$command")
  elif [[ -z $command ]]; then
    words=$(_krater_commands "$program")
  elif [[ $command == models ]]; then
    words=$("$program" models 2>/dev/null | awk '{print $2}')
  else
    # A path with a blank is one word.
    mapfile -t COMPREPLY < <(compgen -d -S / -- "$word"; compgen -f -X '!*.yaml' -- "$word"
      compgen -f -X '!*.yml' -- "$word")
    compopt -o filenames -o nospace
    [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} != */ ]] && compopt +o nospace
    return
  fi
  [[ -n $words ]] && mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -F _krater krater
