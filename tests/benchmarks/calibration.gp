# The figure of docs/algorithms/deformable-calibration.md, from what bench_calibration --steps FILE
# wrote:
#   gnuplot -e "steps='FILE'; out='deformable-calibration.svg'" tests/benchmarks/calibration.gp
set terminal svg size 760,420 font "DejaVu Sans,12" background rgb "white"
set output out
set grid lc rgb "#dddddd"
set xlabel "evaluations"
set ylabel "least error so far (mm)"
set logscale x
set yrange [0:6]
set key top right
plot steps index 1 with steps lw 2 lc rgb "#d1701c" title "three constants, annealing", \
     steps index 0 with steps lw 2 lc rgb "#1f5ca8" title "three constants, descent", \
     steps index 2 with steps lw 2 lc rgb "#7d4fa0" title "grid, annealing", \
     steps index 3 with steps lw 2 lc rgb "#3b8f4e" title "grid, descent"
