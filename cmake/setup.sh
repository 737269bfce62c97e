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
  if ! ninja -C "$root/$folder" -n "$@" | grep -q 'no work to do'; then
    say "building in $folder"
    run_quietly ninja -C "$root/$folder" "$@"
  fi
}
