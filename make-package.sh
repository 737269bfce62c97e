#!/usr/bin/env bash
# Makes Debian packages in out/packages: haptrial (the command with its definitions, manual and
# documents), libhaptrial-dev (headers and static libraries) and python3-haptrial.
#   ./make-package.sh            all
#   ./make-package.sh command    the command alone
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/cmake/setup.sh"

case "${1:-all}" in
  all) components='command;development;python' ;;
  command) components=command ;;
  *) die "'$1' is not known; allowed: nothing or command" ;;
esac

install_packages build package
build build -DHAPTRIAL_TESTS=OFF -DHAPTRIAL_UNITY=ON -DHAPTRIAL_PYTHON=ON
"$root/cmake/man-page.sh" "$root/build/haptrial" "$root/build/haptrial.1.gz"
mkdir -p "$root/out/packages"
run_quietly cpack --config "$root/build/CPackConfig.cmake" -B "$root/out/packages" \
  -D CPACK_COMPONENTS_ALL="$components"
rm -rf "$root/out/packages/_CPack_Packages"
ls -1 "$root"/out/packages/*.deb
