# gnuplot -c plot.gp rare.csv rare.svg SECONDS SECONDS SECONDS: of direct simulation, of splitting, of the chain
call system("dirname ".ARG0)."/../look.gp" 454
set output ARG2
set datafile separator ","
stats ARG1 every ::1 using 5 nooutput
trials = sprintf("%.0f million direct trials", STATS_max / 1e6)
set multiplot
set xrange [0:41]
set grid lt -1 lw 0.2
set pointsize 0.4
set errorbars 0.5
unset mytics
eval text("the chance to get so far, and seconds of one core", 8, 16)
eval panel(84, 494, 32, 262)
eval key_at(96, 204)
set logscale y
set format y "10^{%T}"
set yrange [1e-17:3]
set ytics 1e3
set format x ""
plot ARG1 every ::1 using 1:10 with lines lw 2 lc rgb second title "the chain alone, ".ARG5." s", \
     "" every ::1 using 1:($6 > 0 ? $7 : NaN):8:9 with yerrorbars pt 4 ps 0.7 lc rgb third title trials.", 95 %, ".ARG3." s", \
     "" every ::1 using 1:2:3:4 with yerrorbars pt 7 lc rgb first title "splitting, 95 %, ".ARG4." s more"
unset key
unset label
eval text("as a multiple of what splitting says", 8, 290)
eval panel(84, 494, 306, 392)
unset logscale y
set format y "%g"
set ytics 0.3
set yrange [0.4:1.6]
set format x "%g"
set xlabel "row entered"
# Of direct trials where they saw ten bodies.
plot ARG1 every ::1 using 1:($10/$2) with lines lw 2 lc rgb second, \
     "" every ::1 using 1:($6 >= 10 ? $7/$2 : NaN):($8/$2):($9/$2) with yerrorbars pt 4 ps 0.7 lc rgb third, \
     "" every ::1 using 1:(1):($3/$2):($4/$2) with yerrorbars pt 7 lc rgb first
unset multiplot
