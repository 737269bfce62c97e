#!/bin/bash
# The rehearsal of docs/algorithms/live-hints.md, simulated: safe values from the experts of the
# shipped study, then twelve novices who heed hints in every other of four procedures. Draws
# docs/images/live-hint.png, the 46th second of the first procedure, from its replay.
# live-hints.sh HAPTRIAL FOLDER: the command, where to. WORK names a folder to keep.
set -eu
haptrial=$(realpath "$1")
out=$(realpath "$2")
definition=$(realpath "$(dirname "$0")/../experiments/construct_validity.toml")
work=${WORK:-$(mktemp -d)}
mkdir -p "$work"
sed -e 's/^participants = .*/participants = 8/; s/^novices = 7/# no novices/; s/^novices = 0.15//' \
  "$definition" > "$work/experts.toml"
"$haptrial" dry-run "$work/experts.toml" --out "$work/experts"
"$haptrial" bone safe "$work/safe.toml" --study "$work/experts" --overwrite
sed -e 's/^participants = .*/participants = 12/; s/^procedures = .*/procedures = 4/' \
  -e '/^surgeons = /d; /^residents = /d; s/^novices = 7/novices = 12/' \
  -e 's/^time_limit = .*/time_limit = 120.0/; s/^learning = .*/learning = 0.0\nheeds_hints = 0.8/' \
  -e 's/^name = .*/name = "hint_training"/' "$definition" > "$work/hint_training.toml"
printf '\n[hints]\nfile = "safe.toml"\nshown_in = "every other"\n' >> "$work/hint_training.toml"
"$haptrial" validate "$work/hint_training.toml"
"$haptrial" dry-run "$work/hint_training.toml" --out "$work/trainees"
"$haptrial" analyze "$work/trainees"
"$haptrial" replay "$work/trainees/S01.h5" --frames "$work/frames" --fps 1
cp "$work/frames/frame-00047.png" "$out/live-hint.png"
