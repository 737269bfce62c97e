#!/bin/bash
# Makes alignment-options.svg and step-patterns.svg: HAPTRIAL=build/haptrial docs/algorithms/alignment-options.sh
set -euo pipefail
cd "$(dirname "$0")"
haptrial=$(realpath "${HAPTRIAL:-../../build/haptrial}")
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT

# Two peaks at $1 and $2 of height $3; another at $4 of height $5.
curve() {
  awk -v a="$1" -v b="$2" -v h="$3" -v c="$4" -v g="$5" 'BEGIN {
    print "time,force"
    for (k = 0; k <= 400; ++k) {
      t = k / 100
      print t "," h * exp(-((t - a) / 0.3)^2) + 0.7 * h * exp(-((t - b) / 0.45)^2) \
                  + g * exp(-((t - c) / 0.2)^2)
    }
  }'
}
curve 0.9 2.1 6 0 0 > "$work/target.csv"
curve 1.4 2.8 5.5 0 0 > "$work/late.csv"
curve 1.6 2.9 5.5 0.5 4 > "$work/longer.csv"
align() {
  "$haptrial" align "$work/target.csv" "$work/$2.csv" --samples 401 --filter 0 \
    --out "$work/$1" "${@:3}" > /dev/null
}
align published late
align narrow late --window 0.4
align flat late --slope-weight 0 --penalty 0
align steep late --slope-weight 0.5 --penalty 0
align closed longer
align open longer --open-begin --open-end

cat > "$work/options.gp" <<GP
set terminal svg size 900,760 dynamic font 'sans-serif,13' background '#ffffff'
set output 'alignment-options.svg'
set datafile separator ','
set multiplot layout 2,2 margins 0.08,0.98,0.08,0.95 spacing 0.1,0.15
set key top left reverse Left samplen 2
set xrange [0:3]
set title 'Power p: cost of a difference'
set yrange [0:12]; set xlabel 'difference [N]'; set ylabel 'cost'
plot x title 'p = 1' lw 2 lc '#1a1a1a', x**1.5 title 'p = 1.5' lw 2 dt (9,4) lc '#0072b2', \
  x**2 title 'p = 2' lw 2 dt (3,3) lc '#d55e00', x**4 title 'p = 4' lw 2 dt (9,4,2,4) lc '#009e73'
set xrange [0:4]; set yrange [0:4]
set xlabel 'target [s]'; set ylabel 'applied [s]'
set title 'Slope weight (no penalty)'
plot x notitle lc '#c8ccd0', \
  '$work/flat/path.csv' every 2::1 using 1:2 with lines lw 2 dt (3,3) lc '#d55e00' title 'w_s = 0', \
  '$work/steep/path.csv' every 2::1 using 1:2 with lines lw 2 lc '#0072b2' title 'w_s = 0.5'
set title 'Window of 0.4 s'
set style fill transparent solid 0.5 noborder
plot '+' using 1:(\$1 - 0.4):(\$1 + 0.4) with filledcurves lc '#e8eaec' title 'pairs within it', \
  '$work/published/path.csv' every 2::1 using 1:2 with lines lw 2 dt (3,3) lc '#d55e00' title 'no window', \
  '$work/narrow/path.csv' every 2::1 using 1:2 with lines lw 2 lc '#0072b2' title 'window'
set title 'Open begin and end'
plot x notitle lc '#c8ccd0', \
  '$work/closed/path.csv' every 2::1 using 1:2 with lines lw 2 dt (3,3) lc '#d55e00' title 'closed', \
  '$work/open/path.csv' every 2::1 using 1:2 with lines lw 2 lc '#0072b2' title 'open'
unset multiplot
GP
gnuplot "$work/options.gp"

cat > "$work/steps.gp" <<'GP'
set terminal svg size 900,245 dynamic font 'sans-serif,13' background '#ffffff'
set output 'step-patterns.svg'
unset border; unset tics; unset key
set xrange [-0.7:2.5]; set yrange [-2.6:0.9]; set size ratio 1.09
set multiplot layout 1,4 margins 0.01,0.99,0.02,0.98 spacing 0.01,0
dots = "plot for [i=0:2] '+' using (int($0)):(-i) every ::0::2 with points pt 7 ps 0.5 lc '#c8ccd0'"
set samples 3
# Every step ends in the lower right; a number is the weight of the error of the pair it reaches.
arrow(x1, y1, x2, y2) = sprintf("set arrow from %g,%g to %g,%g head filled size 0.12,20 lw 2 lc '#0072b2'", x1, y1, x2, y2)
weight(x, y, w) = sprintf("set label '%s' at %g,%g center font ',13'", w, x, y)
set label 'published, symmetric1' at 0.9,0.6 center font ',14'
set label 'target' at -0.35,-1 center rotate by -90; set label 'applied' at 1,-2.45 center
eval arrow(1, -1, 2, -2); eval arrow(2, -1, 2, -2); eval arrow(1, -2, 2, -2)
eval weight(1.4, -1.62, '1'); eval weight(2.15, -1.5, '1'); eval weight(1.5, -2.2, '1')
eval dots
unset arrow; unset label
set label 'symmetric2' at 0.9,0.6 center font ',14'
eval arrow(1, -1, 2, -2); eval arrow(2, -1, 2, -2); eval arrow(1, -2, 2, -2)
eval weight(1.4, -1.62, '2'); eval weight(2.15, -1.5, '1'); eval weight(1.5, -2.2, '1')
eval dots
unset arrow; unset label
set label 'asymmetric' at 0.9,0.6 center font ',14'
eval arrow(1, -1, 2, -2); eval arrow(2, -1, 2, -2); eval arrow(0, -1, 2, -2)
eval weight(1.65, -1.4, '1'); eval weight(2.15, -1.5, '1'); eval weight(0.8, -1.62, '1')
eval dots
unset arrow; unset label
set label 'symmetricP1' at 0.9,0.6 center font ',14'
eval arrow(1, -1, 2, -2); eval arrow(1, 0, 2, -1); eval arrow(2, -1, 2, -2)
eval arrow(0, -1, 1, -2); eval arrow(1, -2, 2, -2)
eval weight(1.4, -1.62, '2'); eval weight(1.65, -0.4, '2'); eval weight(2.15, -1.5, '1')
eval weight(0.35, -1.62, '2'); eval weight(1.5, -2.2, '1')
eval dots
unset multiplot
GP
gnuplot "$work/steps.gp"
