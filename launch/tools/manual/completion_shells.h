// SPDX-License-Identifier: Apache-2.0
// Templates of the completion scripts: @TABLE@, @LEVELS@ and @PROGRAMS@ are replaced.
#pragma once

namespace shoal::launch {

// bash splits the command line at '=', so '=' is a separate word.
inline constexpr char kBashCompletion[] =
    R"(# bash completion of Shoal's programs, made from their command lines

@TABLE@
_shoal() {
  local at=$COMP_CWORD current=${COMP_WORDS[COMP_CWORD]} level=${COMP_WORDS[0]##*/} i rows word before
  if [[ $current == '=' ]]; then
    current= at=$((at + 1))
  fi
  for ((i = 1; i < at; ++i)); do
    case "$level ${COMP_WORDS[i]}" in
      @LEVELS@) level+=" ${COMP_WORDS[i]}" ;;
    esac
  done
  before=${COMP_WORDS[at - 1]}
  COMPREPLY=()
  if [[ $before == '=' && ${COMP_WORDS[at - 2]} != -* ]]; then
    rows=$(_shoal_table "= ${COMP_WORDS[at - 2]}")
  else
    [[ $before == '=' ]] && before=${COMP_WORDS[at - 2]}
    if [[ $before == -* ]] && rows=$(_shoal_table "$level $before"); then
      :
    elif [[ $current == -* ]]; then
      rows=$(_shoal_table "$level -")
    else
      rows=$(_shoal_table "$level")
    fi
  fi
  while IFS=$'\t' read -r word _; do
    [[ -n $word && $word == "$current"* ]] && COMPREPLY+=("$word")
  done <<<"$rows"
  # A key goes on with its value.
  [[ ${COMPREPLY[0]-} == *= ]] && compopt -o nospace 2>/dev/null
  return 0
}

complete -o default -F _shoal @PROGRAMS@
)";

inline constexpr char kZshCompletion[] = R"(#compdef @PROGRAMS@
# zsh completion of Shoal's programs, made from their command lines

@TABLE@
_shoal() {
  local level=${words[1]:t} current=${words[CURRENT]} before=${words[CURRENT - 1]} i row text
  local -a rows names notes
  for ((i = 2; i < CURRENT; ++i)); do
    case "$level ${words[i]}" in
      @LEVELS@) level+=" ${words[i]}" ;;
    esac
  done
  if [[ $current == *=* ]]; then
    compset -P '*='
    if [[ $current == -* ]]; then
      text=$(_shoal_table "$level ${current%%=*}")
    else
      text=$(_shoal_table "= ${current%%=*}")
    fi
  elif [[ $before == -* ]] && text=$(_shoal_table "$level $before"); then
    :
  elif [[ $current == -* ]]; then
    text=$(_shoal_table "$level -")
  else
    text=$(_shoal_table "$level")
  fi
  for row in "${(@f)text}"; do
    [[ -n $row ]] || continue
    names+=("${row%%$'\t'*}")
    notes+=("${row%%$'\t'*}  ${row#*$'\t'}")
  done
  if (( $#names == 0 )); then
    _files
  elif [[ $names[1] == *= ]]; then
    compadd -l -S '' -d notes -a names  # a key goes on with its value
  else
    compadd -l -d notes -a names
  fi
}

_shoal "$@"
)";

inline constexpr char kFishCompletion[] =
    R"(# fish completion of Shoal's programs, made from their command lines

@TABLE@
function __shoal_candidates
  set -l words (commandline -opc)
  set -l current (commandline -ct)
  set -l level (string replace -r '.*/' '' -- $words[1])
  for word in $words[2..-1]
    if contains -- "$level $word" @LEVELS@
      set level "$level $word"
    end
  end
  set -l before $words[-1]
  set -l rows
  if string match -q -- '*=*' $current
    set -l name (string split -m 1 = -- $current)[1]
    set -l place "= $name"
    if string match -q -- '-*' $name
      set place "$level $name"
    end
    for row in (__shoal_table $place)
      set -a rows "$name=$row"
    end
  else
    set -l known 1
    if string match -q -- '-*' $before
      set rows (__shoal_table "$level $before"); and set known 0
    end
    if test $known -ne 0
      if string match -q -- '-*' $current
        set rows (__shoal_table "$level -")
      else
        set rows (__shoal_table $level)
      end
    end
  end
  if test (count $rows) -eq 0
    __fish_complete_path $current
  else
    printf '%s\n' $rows
  end
end

for program in @PROGRAMS@
  complete -c $program -f -a '(__shoal_candidates)'
end
)";

}  // namespace shoal::launch
