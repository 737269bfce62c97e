# Completion of the haptrial command: source this file, or copy it to /etc/bash_completion.d/haptrial.
_haptrial() {
  local word=${COMP_WORDS[COMP_CWORD]} at=1 sub names words part
  while [ "${COMP_WORDS[at]}" = --plugin ] && [ $((at + 1)) -lt "$COMP_CWORD" ]; do
    at=$((at + 2))
  done
  sub=${COMP_WORDS[at]}
  names=$(haptrial --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p')
  if [ "$COMP_CWORD" -eq "$at" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$names --help --version --plugin" -- "$word")
  elif [ "$sub" = --plugin ]; then
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  elif [ "$COMP_CWORD" -eq $((at + 1)) ] && [[ $sub =~ ^(mesh|bone|deform|rate|power)$ ]]; then
    names=$(haptrial "$sub" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p')
    mapfile -t COMPREPLY < <(compgen -W "$names --help" -- "$word")
  elif [[ $word == -* ]]; then
    [[ $sub =~ ^(mesh|bone|deform|rate|power)$ ]] && part=${COMP_WORDS[at + 1]}
    words=$(haptrial "$sub" ${part:+"$part"} --help 2>/dev/null | grep -o -- '--[a-z-]*' | sort -u)
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -F _haptrial haptrial
