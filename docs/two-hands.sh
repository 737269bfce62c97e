#!/bin/bash
# Draws docs/images/two-hands.png: three moments of a dry run of experiments/two_hands.toml, from its
# replay. Needs ffmpeg.
# two-hands.sh HAPTRIAL FOLDER: the command, where to.
set -eu
haptrial=$(realpath "$1")
out=$(realpath "$2")
definition=$(realpath "$(dirname "$0")/../experiments/two_hands.toml")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$haptrial" dry-run "$definition" --out "$work/out"
"$haptrial" replay "$work/out/S01.h5" --frames "$work/frames" --fps 1
for second in 06 20 40; do
  cp "$work/frames/frame-000$second.png" "$work/moment-$second.png"
done
ffmpeg -v error -y -pattern_type glob -i "$work/moment-*.png" -frames:v 1 \
  -vf "crop=640:480:230:90,scale=426:320:flags=lanczos,pad=428:322:1:1:white,tile=3x1" \
  "$out/two-hands.png"
