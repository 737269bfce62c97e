#!/usr/bin/env bash
# Makes Debian packages in out/packages: haptrial (the command with its definitions, manual and
# documents), libhaptrial-dev (headers and static libraries) and python3-haptrial; or a tarball of the
# command that runs where it is unpacked, on other distributions, too.
#   ./make-package.sh            all packages
#   ./make-package.sh command    that of the command alone
#   ./make-package.sh tarball    haptrial-VERSION-MACHINE.tar.xz
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/cmake/setup.sh"

case "${1:-all}" in
  all) components='command;development;python' ;;
  command | tarball) components=command ;;
  *) die "'$1' is not known; allowed: nothing, command or tarball" ;;
esac

install_packages build package
build build -DHAPTRIAL_TESTS=OFF -DHAPTRIAL_UNITY=ON -DHAPTRIAL_PYTHON=ON
"$root/cmake/man-page.sh" "$root/build/haptrial" "$root/build/haptrial.1.gz"
mkdir -p "$root/out/packages"
if [ "${1:-all}" = tarball ]; then
  version=$(sed -n 's/^project(haptrial VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
  name=haptrial-$version-$(uname -m)
  stage=$(mktemp -d "$root/out/packages/XXXXXX")
  trap 'rm -rf "$stage"' EXIT
  "$root/cmake/bundle.sh" "$root/build" "$stage/$name"
  tar -C "$stage" --sort=name --owner=0 --group=0 -cf - "$name" | xz -T0 -3 >"$stage/packed"
  mv "$stage/packed" "$root/out/packages/$name.tar.xz"
  say "out/packages/$name.tar.xz"
  exit
fi
run_quietly cpack --config "$root/build/CPackConfig.cmake" -B "$root/out/packages" \
  -D CPACK_COMPONENTS_ALL="$components"
rm -rf "$root/out/packages/_CPack_Packages"
ls -1 "$root"/out/packages/*.deb
