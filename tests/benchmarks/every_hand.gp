# The picture of docs/algorithms/every-hand.md, from what bench_every_hand wrote:
#   bench_every_hand FILE
#   gnuplot -e "data='FILE'; out='docs/images/every-hand.svg'" tests/benchmarks/every_hand.gp
set terminal svg size 900,360 font "DejaVu Sans,12" background rgb "white"
set output out
set grid lc rgb "#dddddd"
set key right top Left reverse
set title "A handle that is let go at 0 ms (simulated): force along y"
set xlabel "time [ms]"
set ylabel "force [N]"
set xrange [-50:200]
set yrange [-13:13]
plot data u 1:2 w l lc rgb "#d1701c" lw 1.5 t "without the guard, until the envelope ends the pass", \
     data u 1:3 w l lc rgb "#1f5ca8" lw 2 t "with the guard"
