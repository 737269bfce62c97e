#!/bin/bash
# Draws docs/images/osteotomy.jpg: four moments of the shipped osteotomy by its virtual hand, from
# its replay. Needs ffmpeg.
# osteotomy.sh HAPTRIAL FOLDER: the command, where to.
set -eu
haptrial=$(realpath "$1")
out=$(realpath "$2")
definition=$(realpath "$(dirname "$0")/../experiments/mandible_osteotomy.toml")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$haptrial" dry-run "$definition" --out jaw
"$haptrial" replay jaw/S01.h5 --frames frames --fps 1
i=0
for second in 00008 00031 00034 00059; do
  cp "frames/frame-$second.png" "$((++i)).png"
done
ffmpeg -v error -y -i %d.png -frames:v 1 \
  -vf "scale=640:360:flags=lanczos,pad=642:362:1:1:white,tile=2x2" -q:v 4 "$out/osteotomy.jpg"
