# The picture of docs/algorithms/mixed-model.md, from what bench_null_conditions wrote:
#   bench_null_conditions results/force_training/scores.csv 400 1 FILE
#   gnuplot -e "data='FILE'; out='docs/algorithms/mixed-model.svg'" tests/benchmarks/null_conditions.gp
set terminal svg size 900,400 font "DejaVu Sans,12" background rgb "white"
set output out
set datafile separator ","
set grid lc rgb "#dddddd"
set xrange [0:0.2]
set yrange [0:1]
set xtics 0.05
set xlabel "p"
set key left top Left reverse samplen 2
of(scheme, column) = $1 == scheme && $2 == 12 ? column : NaN
set multiplot layout 1,2
do for [scheme = 0:1] {
  set title (scheme == 0 ? "labels permuted over blocks" : "names permuted for each participant")
  set ylabel (scheme == 0 ? "share of the studies at or below p" : "")
  if (scheme == 1) { unset key }
  plot data skip 1 u (of(scheme, $6)):(1) smooth cnormal lw 2 lc rgb "#999999" t "pooled trials", \
       data skip 1 u (of(scheme, $5)):(1) smooth cnormal lw 2 lc rgb "#d1701c" t "random intercept alone", \
       data skip 1 u (of(scheme, $4)):(1) smooth cnormal lw 2 lc rgb "#4a9a5a" t "repeated measures", \
       data skip 1 u (of(scheme, $3)):(1) smooth cnormal lw 2 lc rgb "#1f5ca8" t "mixed model", \
       x lc rgb "#000000" dt 2 t "as it should be"
}
unset multiplot
