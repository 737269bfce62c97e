#!/bin/bash
# Draws the planned cavities of the validity study: stage-1.jpg to stage-4.jpg of the shipped bone,
# cavity-ear3.jpg and cavity-rt138.jpg of two labelled ears. Needs ffmpeg.
# cavities.sh HAPTRIAL EARS FOLDER: the command, the folder of the ears, where to.
set -eu
haptrial=$(realpath "$1")
ears=$(realpath "$2")
out=$(realpath "$3")
definition=$(realpath "$(dirname "$0")/../experiments/construct_validity.toml")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# draw STILL PICTURE: half as wide.
draw() {
  ffmpeg -v error -y -i "$1" -vf scale=640:360:flags=lanczos -q:v 3 "$out/$2"
}
"$haptrial" bone stages "$definition" --out stages --count 4
number=0
for still in stages/*.png; do
  number=$((number + 1))
  draw "$still" "stage-$number.jpg"
done
for ear in ear3_171 RT138_256; do
  cp "$ears/${ear}_labels.nrrd" .
  sed "s/^bones = .*/bones = [\"${ear}_labels.nrrd\"]/" "$definition" >"$ear.toml"
  "$haptrial" bone stages "$ear.toml" --out "$ear" --count 2
done
draw "$(ls ear3_171/*.png | tail -1)" cavity-ear3.jpg
draw "$(ls RT138_256/*.png | tail -1)" cavity-rt138.jpg
