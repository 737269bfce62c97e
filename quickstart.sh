#!/usr/bin/env bash
# Installs what is missing, builds haptrial, and runs the force-skill training study with virtual subjects.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/cmake/setup.sh"

install_packages build
build build -DHAPTRIAL_TESTS=OFF -DHAPTRIAL_UNITY=ON -- haptrial
cd "$root"
study=$(build/haptrial dry-run experiments/force_training.toml) || exit $?
say "$study"
folder=$(sed -n 's/^sessions: //p' <<<"$study")
build/haptrial analyze "$folder"
say "build/haptrial examples lists every experiment"
