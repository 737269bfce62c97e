#!/bin/bash
# Makes tutoring.svg, where a led hand is beside its tutor's: HAPTRIAL=build/haptrial docs/algorithms/tutoring.sh
set -euo pipefail
cd "$(dirname "$0")"
haptrial=$(realpath "${HAPTRIAL:-../../build/haptrial}")
study=$(realpath ../../experiments/force_training.toml)
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT

"$haptrial" dry-run "$study" --subjects 1 --trials 4 --out "$work/tutor" > /dev/null
"$haptrial" dry-run "$study" --subjects 1 --trials 1 --seed 7 --tutor "$work/tutor/S01.h5:4" \
  --out "$work/led" > /dev/null
/usr/bin/python3 - "$work/led/S01.h5" > "$work/paths" <<'PY'
import sys, h5py
with h5py.File(sys.argv[1]) as f:
    rows, samples = f["tutoring"][:], f["samples"][:]
first = rows["sequence"][0]
for row in rows[rows["lead"] == 1][::10]:
    own = samples[row["sequence"]]
    print(1e-3 * (row["sequence"] - first), 1e3 * row["position_x"], 1e3 * own["position_x"],
          row["tutor_force_y"], row["played_force_y"])
PY
gnuplot <<GP
set terminal svg size 900,420 dynamic font 'sans-serif,13' background '#ffffff'
set output 'tutoring.svg'
set multiplot layout 1,2 margins 0.07,0.98,0.13,0.92 spacing 0.09,0.1
set key top left reverse Left samplen 2
set xlabel 'time [s]'; set xrange [0:13]
set ylabel 'x [mm]'; set title 'Where the tools are'
plot '$work/paths' using 1:2 with lines lw 2 lc '#0072b2' title "tutor's", \
  '' using 1:3 with lines lw 2 dt (6,4) lc '#d55e00' title 'led'
set ylabel 'upward force [N]'; set title 'What the hands feel'
plot '$work/paths' using 1:4 with lines lw 2 lc '#0072b2' title "tutor's", \
  '' using 1:5 with lines lw 2 dt (6,4) lc '#d55e00' title 'led'
unset multiplot
GP
