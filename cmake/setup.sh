# Shared by quickstart.sh and check.sh; sourced, with $root set to the checkout.

say() { printf '%s\n' "$*"; }
die() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

# install_packages GROUP...: installs what is missing of these groups of packages.txt, else is quiet.
install_packages() {
  local group package missing=() asroot=()
  while read -r group package _; do
    case " $* " in
      *" $group "*) ;;
      *) continue ;;
    esac
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
      missing+=("$package")
  done < <(grep -v '^#' "$root/cmake/packages.txt")
  [ ${#missing[@]} -eq 0 ] && return 0
  command -v apt-get >/dev/null || die "needs Debian 12's packages: ${missing[*]}"
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "run as root, or install these packages first: ${missing[*]}"
    asroot=(sudo)
  fi
  say "installing ${#missing[@]} packages: ${missing[*]}"
  run_quietly "${asroot[@]}" apt-get update -q
  run_quietly "${asroot[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -q -y --no-install-recommends "${missing[@]}"
}

# run_quietly COMMAND...: shows what it printed only when it fails.
run_quietly() {
  local log
  log=$(mktemp)
  if ! "$@" >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    rm -f "$log"
    die "failed: $*"
  fi
  rm -f "$log"
}

# show_progress WHAT: reads ninja's lines, shows the share done: on a terminal in one line, else in
# steps of 10 %.
show_progress() {
  local line done total share shown=-1 text='' step=10 end='\n'
  [ -t 1 ] && step=1 end='\r'
  while IFS= read -r line; do
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\]\ (.*) ]] || continue
    [[ ${BASH_REMATCH[3]} == Re-* ]] && continue  # cmake looks for new files
    done=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]}
    share=$((100 * done / total / step * step))
    [ "$share" -gt "$shown" ] || continue
    shown=$share text="$1: $((100 * done / total)) % ($done of $total)"
    printf "%s$end" "$text"
  done
  if [ -t 1 ] && [ -n "$text" ]; then printf '\n'; fi
}

# build FOLDER [CMAKE OPTION...] [-- TARGET...]: configures and builds; quiet when all is up to date.
build() {
  local folder=$1 options=()
  shift
  while [ $# -gt 0 ] && [ "$1" != -- ]; do
    options+=("$1")
    shift
  done
  [ "${1:-}" = -- ] && shift
  run_quietly cmake -S "$root" -B "$root/$folder" -G Ninja "${options[@]}"
  if ! ninja -C "$root/$folder" -n "$@" | grep 'no work to do' >/dev/null; then
    run_ninja "$folder" "$@"
  fi
}

# run_ninja FOLDER [TARGET...]: one line of progress; the compiler's words only when it fails.
run_ninja() {
  local folder=$1 log
  log=$(mktemp)
  shift
  if ! NINJA_STATUS='[%f/%t] ' ninja -C "$root/$folder" "$@" 2>&1 | tee "$log" |
    show_progress "building in $folder"; then
    tail -n 40 "$log" >&2
    rm -f "$log"
    die "failed: ninja -C $root/$folder $*"
  fi
  rm -f "$log"
}
