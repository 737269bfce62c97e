# Completion of the haptrial command: source this file, or copy it to /etc/bash_completion.d/haptrial.
_haptrial() {
  local word=${COMP_WORDS[COMP_CWORD]} sub=${COMP_WORDS[1]} names words part
  names=$(haptrial --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p')
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "$names --help --version" -- "$word")
  elif [ "$COMP_CWORD" -eq 2 ] && [[ $sub =~ ^(mesh|bone|deform|rate|power)$ ]]; then
    names=$(haptrial "$sub" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p')
    mapfile -t COMPREPLY < <(compgen -W "$names --help" -- "$word")
  elif [[ $word == -* ]]; then
    [[ $sub =~ ^(mesh|bone|deform|rate|power)$ ]] && part=${COMP_WORDS[2]}
    words=$(haptrial "$sub" ${part:+"$part"} --help 2>/dev/null | grep -o -- '--[a-z-]*' | sort -u)
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -F _haptrial haptrial
