#!/bin/bash
# Draws ct-slices.png of guide-bone.md: the last picture of a dry run of the shipped drilling, with
# slices beside it. ct-slices.sh HAPTRIAL FOLDER: the command, where to.
set -eu
haptrial=$(realpath "$1")
out=$(realpath "$2")
definition=$(realpath "$(dirname "$0")/../experiments/bone_drilling.toml")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$haptrial" dry-run "$definition" --set display.slices=true --set drilling.time_limit=20.0 \
  --frames 2 --out "$work/drilled" >/dev/null
cp "$(find "$work/drilled" -name '*.png' | sort | tail -1)" "$out/ct-slices.png"
