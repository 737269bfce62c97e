#!/usr/bin/env bash
# Installs what is missing, builds the force studies, runs the force-skill training study with virtual
# subjects, and then builds the rest.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/cmake/setup.sh"

install_packages build
options=(-DHAPTRIAL_TESTS=OFF -DHAPTRIAL_UNITY=ON)
build build "${options[@]}" -- haptrial_forces
cd "$root"
study=$(build/haptrial_forces dry-run experiments/force_training.toml) || exit $?
say "$study"
folder=$(sed -n 's/^sessions: //p' <<<"$study")
build/haptrial_forces analyze "$folder"

say ""
say "The rest of haptrial is built now; where you stop it, ./quickstart.sh goes on."
build build "${options[@]}" -- haptrial
say "build/haptrial has every experiment: build/haptrial examples lists them"
