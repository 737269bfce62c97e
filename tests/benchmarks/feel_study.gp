# The figures of docs/algorithms/bone-feel.md, from what bench_feel_study wrote:
#   bench_feel_study FOLDER
#   gnuplot -e "folder='FOLDER'" tests/benchmarks/feel_study.gp
S=folder."/"
set terminal svg size 900,640 font "DejaVu Sans,12" background rgb "white"
set output S."bone-feel.svg"
set multiplot layout 2,2
set grid lc rgb "#dddddd"
set key left top Left reverse
set style line 1 lc rgb "#d1701c" lw 2 pt 5 ps 0.6
set style line 2 lc rgb "#3b8f4e" lw 2 pt 9 ps 0.7
set style line 3 lc rgb "#7d4fa0" lw 2 pt 13 ps 0.7
set style line 4 lc rgb "#1f5ca8" lw 2 pt 7 ps 0.6
set title "Figure 6: force of the immersed volume, 4 mm burr"
set xlabel "immersed volume [mm³]"
set ylabel "force [N]"
set xrange [0:1.2]
plot S."mapping.dat" u 3:4 w l ls 4 notitle
set title "Pressed into flat bone"
set xlabel "depth [mm]"
set xrange [0:1]
set yrange [0:13]
plot S."mapping.dat" u 1:5 w l lc rgb "#999999" lw 5 t "of the cap's volume", \
     S."mapping.dat" u 1:4 w l ls 4 t "of 11,486 samples"
set title "A hand without friction, 3 N: does it rest?"
set xlabel "stiffness [N/mm]"
set ylabel "movement, worst of 8 poses [µm]"
set logscale y
set xrange [0:50]
set yrange [0.1:3000]
set key left top
set arrow from 30,0.1 to 30,3000 nohead dt 2 lc rgb "#555555"
set label "2 b / T" at 30.6,0.2 front tc rgb "#555555"
plot S."rest-rays-26.dat" u 2:3 w lp ls 1 t "26 rays", S."rest-rays-56.dat" u 2:3 w lp ls 2 t "56 rays", \
     S."rest-rays-250.dat" u 2:3 w lp ls 3 t "250 rays", S."rest-volume.dat" u 2:3 w lp ls 4 t "volume"
unset arrow
unset label
unset logscale
set title "A plate of 0.5 mm"
set xlabel "depth [mm]"
set ylabel "force [N]"
set xrange [0:2]
set yrange [0:10]
set key left top
plot S."plate-rays-56.dat" w l ls 2 t "56 rays", S."plate-rays-250.dat" w l ls 3 t "250 rays", \
     S."plate-volume.dat" w l ls 4 t "volume"
unset multiplot

set terminal pngcairo size 1000,270 font "DejaVu Sans,11" background rgb "white"
set output S."drilled-floor.png"
set multiplot layout 1,3
unset grid
unset key
set xlabel "along the trench [mm]"
set ylabel "across [mm]" offset 1,0
set cblabel "height [mm]"
set xrange [-2.5:2.5]
set yrange [-2:2]
set cbrange [-0.9:0]
set size ratio -1
set palette defined (0 "#123a63", 0.5 "#6f9fc9", 1 "#f4ead2")
do for [m in "rays-56 rays-250 volume"] {
  set title (m eq "volume" ? "volume, 11,486 samples" : m eq "rays-56" ? "56 rays" : "250 rays")
  plot S."floor-".m.".dat" u 1:2:3 w image
}
unset multiplot
