# The figures of docs/algorithms/distance-maps.md, from what bench_distance_study wrote:
#   bench_distance_study FOLDER bunny.obj dragon.obj
#   gnuplot -e "folder='FOLDER'" tests/benchmarks/distance_study.gp
set terminal svg size 900,640 font "DejaVu Sans,12" background rgb "white"
set output folder."/distance-maps.svg"
set multiplot layout 2,2
set grid lc rgb "#dddddd"
set key left top Left reverse
set style line 1 lc rgb "#1f5ca8" lw 2 pt 7 ps 0.7
set style line 2 lc rgb "#d1701c" lw 2 pt 5 ps 0.7
set style line 3 lc rgb "#3b8f4e" lw 2 pt 9 ps 0.8
set style line 4 lc rgb "#7d4fa0" lw 2 pt 13 ps 0.8
S=folder."/"
set title "Figure 53: time against resolution"
set xlabel "voxels along the long axis"
set ylabel "seconds, one thread"
set logscale xy
set xtics (30,75,135,195)
set yrange [0.0004:40]
set xrange [25:900]
set key right center
set format y "10^{%T}"
plot S."resolution-bunny.dat" u 1:3 w lp ls 1 t "bunny, source", \
     S."resolution-dragon.dat" u 1:3 w lp ls 2 t "dragon, source", \
     S."resolution-rough.dat" u 1:3 w lp ls 3 t "rough, source", \
     S."resolution-gear.dat" u 1:3 w lp ls 4 t "gear, source", \
     S."resolution-bunny.dat" u 1:5 w lp ls 1 dt 2 t "bunny, ours", \
     S."resolution-gear.dat" u 1:5 w lp ls 4 dt 2 t "gear, ours"
unset logscale
set xrange [*:*]
set format y "%g"
set key right top
set title "Figure 54: the seed's height, depth first, long axis 135"
set xlabel "TREE\\_ASCEND\\_N"
set ylabel "boxes and triangles tested per voxel"
set xtics -1,1,4 
set yrange [0:3300]
set xrange [-1.2:4.2]
f(n)="< awk '$1==135 && $2==\"depth\"' ".S."seeds-".n.".dat"
g(n)="< awk '$1==135 && $2==\"breadth\"' ".S."seeds-".n.".dat"
plot f("bunny") u 3:4 w lp ls 1 t "bunny", f("dragon") u 3:4 w lp ls 2 t "dragon", f("rough") u 3:4 w lp ls 3 t "rough", f("gear") u 3:4 w lp ls 4 t "gear"
set title "Figure 55: depth and breadth first, seeded (N = 0)"
set xlabel "voxels along the long axis"
set xtics (30,75,135)
set xrange [20:145]
set yrange [0:700]
d(n,a)="< awk '$3==".a." && $2==\"depth\"' ".S."seeds-".n.".dat"
b(n,a)="< awk '$3==".a." && $2==\"breadth\"' ".S."seeds-".n.".dat"
plot d("bunny",0) u 1:4 w lp ls 1 t "bunny, depth", b("bunny",0) u 1:4 w lp ls 1 dt 2 t "breadth", d("gear",0) u 1:4 w lp ls 4 t "gear, depth", b("gear",0) u 1:4 w lp ls 4 dt 2 t "breadth"
set title "Figure 56: the same without a seed (N = -1)"
set yrange [0:3300]
plot d("bunny",-1) u 1:4 w lp ls 1 t "bunny, depth", b("bunny",-1) u 1:4 w lp ls 1 dt 2 t "breadth", d("gear",-1) u 1:4 w lp ls 4 t "gear, depth", b("gear",-1) u 1:4 w lp ls 4 dt 2 t "breadth"
unset multiplot
