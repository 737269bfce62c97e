#!/usr/bin/env bash
# bundle.sh BUILD FOLDER: installs the command with its definitions, manual, documents and every
# library but the C library's own into FOLDER, which then runs wherever it is moved, without root, on
# Linux of the same age or newer (glibc).
#   cmake/bundle.sh build out/haptrial-0.2.0
set -euo pipefail
build=$1 top=$2
[ ! -e "$top" ] || { echo "bundle.sh: '$top' exists" >&2; exit 1; }
cmake --install "$build" --component command --prefix "$top" >/dev/null
mkdir -p "$top/lib" "$top/share/doc/haptrial/licenses"

# What the kernel, the loader and the C library give must be the machine's.
machine='^(linux-vdso|ld-linux[a-z0-9-]*|libc|libm|libmvec|libdl|librt|libpthread|libresolv|libutil|libanl)\.so'

# libraries FILE: name and path of every library that it is linked with, as the loader finds them.
libraries() { ldd "$1" | awk '$2 == "=>" { print $1, $3 }'; }

# all_libraries: those of the command, and OSMesa's, which the command loads when it draws.
osmesa=$(/sbin/ldconfig -p | awk '$1 == "libOSMesa.so.8" && !found++ { print $NF }')
[ -n "$osmesa" ] || { echo "bundle.sh: not found: libOSMesa.so.8" >&2; exit 1; }
all_libraries() {
  { libraries "$top/bin/haptrial"; echo "libOSMesa.so.8 $osmesa"; libraries "$osmesa"; } | sort -u
}

# package_of FILE: whose it is; dpkg knows some files of /usr/lib as those of /lib.
package_of() {
  { dpkg-query -S "$1" || dpkg-query -S "${1#/usr}" || true; } 2>/dev/null | sed -n '1s/:.*//p'
}

missing=$(all_libraries | awk '$2 == "not" { print $1 }')
[ -z "$missing" ] || { echo "bundle.sh: not found: $missing" >&2; exit 1; }
all_libraries | while read -r library path; do
  [[ $library =~ $machine ]] && continue
  install -m 644 "$path" "$top/lib/$library"
  patchelf --set-rpath '$ORIGIN' "$top/lib/$library"
  package=$(package_of "$(readlink -f "$path")")
  copyright=/usr/share/doc/$package/copyright
  [ -z "$package" ] || [ ! -f "$copyright" ] ||
    cp -L "$copyright" "$top/share/doc/haptrial/licenses/$package"
done
patchelf --set-rpath '$ORIGIN/../lib' "$top/bin/haptrial"
