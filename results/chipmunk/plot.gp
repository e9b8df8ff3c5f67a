# gnuplot -c plot.gp held.csv endings.csv chipmunk.svg
call system("dirname ".ARG0)."/../look.gp" 506
set output ARG3
set datafile separator ","
set multiplot
set grid lt -1 lw 0.2
set errorbars 0.5
eval text("How bodies from the scene's start end, %, 95 %", 8, 16)
eval panel(64, 494, 30, 200)
eval key_at(76, 34)
set xrange [-0.5:3.5]
set xtics ("left side" 0, "right side" 1, "trapped" 2, "cut off" 3)
set yrange [0:90]
set ytics 20
plot for [k=0:3] ARG2 using (int($0) / 4 == k ? int($0) % 4 + 0.12 * (k - 1.5) : NaN):(100*$4):(100*$5):(100*$6) every ::1 \
     with yerrorbars pt (k % 2 == 0 ? 7 : 4) lc rgb (k < 2 ? first : second) \
     title word("Chipmunk ours", 1 + k / 2).(k % 2 == 0 ? ", direct trials" : ", chain")
unset label
eval text("Do bars hold? trapped, 300 starts, three pools of trials", 8, 250)
eval panel(64, 494, 276, 450)
eval key_at(390, 366)
set xrange [0:1]
set yrange [0:1]
set xtics 0.2
set ytics 0.2
set xlabel "where direct trials lie in what the chain says (probability)"
set ylabel "starts below"
colours = first." ".second." ".third
plot x with lines lw 1 lc rgb "#404040" dt 2 title "right bars", \
     for [k=1:3] ARG1 using (column("trapped_integral")):(strcol(1) eq "pool" && column("seed") == k ? 1 : NaN) \
     smooth cnorm with lines lw 1.5 lc rgb word(colours, k) title "pool ".k
unset multiplot
