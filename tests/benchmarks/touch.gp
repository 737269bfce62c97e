# Draws deformable-touch.svg from touch.dat: bench_touch felt > touch.dat; gnuplot touch.gp
set terminal svg size 640,400 font "sans-serif,13" background "white"
set output "deformable-touch.svg"
set xlabel "ball in the block at rest (mm)"
set ylabel "force (N)"
set key top left
set grid lc rgb "#dddddd"
hertz(d) = 4.0 / 3.0 * 15e3 / (1 - 0.45**2) * sqrt(0.005) * (1e-3 * d)**1.5
plot for [i=0:3] "touch.dat" index i using 1:2 with lines lw 2 title word("none 5 3 1", i + 1) eq "none" ? "no lump" : sprintf("lump %s mm deep", word("none 5 3 1", i + 1)), \
     [0:3] hertz(x) with lines dt 2 lc rgb "#888888" title "Hertz, half space"
