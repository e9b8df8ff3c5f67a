# gnuplot -c plot.gp lorentz.csv leaves.csv lorentz.svg
call system("dirname ".ARG0)."/../look.gp" 454
set output ARG3
set datafile separator ","
set multiplot
set grid lt -1 lw 0.2
set pointsize 0.5
set errorbars 0.5
unset mytics
eval text("D as a multiple of that of hops without memory", 8, 16)
eval panel(64, 494, 32, 232)
eval key_at(70, 36)
set xrange [0.03:0.32]
set xtics 0.05
set yrange [0.75:1.5]
set ytics 0.2
set xlabel "gap between discs of radius 1"
plot ARG1 every ::1 using 1:(1) with lines lw 2 lc rgb fourth title "no memory (Machta, Zwanzig)", \
     "" every ::1 using 1:($5/$2) with lines lw 2 lc rgb second title "one step of memory", \
     "" every ::1 using 1:($7/$2):(2*$8/$2) with yerrorbars pt 4 ps 0.9 lc rgb third title "direct simulation, 95 %", \
     "" every ::1 using 1:($9/$2):($10/$2):($11/$2) with yerrorbars pt 7 lc rgb first title "chain of trees, 95 %"
eval text("off direct simulation, per cent", 8, 272)
eval panel(64, 494, 288, 404)
eval key_at(330, 352)
set logscale x
set xrange [3:60000]
set xtics (4, 32, 256, "2048" 2048, "16384" 16384)
set yrange [-22:4]
set ytics 5
set xlabel "states of the chain, for the same 20 000 trials"
direct(gap) = real(system(sprintf("awk -F, '$1 == %g {print $7}' %s", gap, ARG1)))
plot for [gap in "0.05 0.3"] ARG2 every ::1 using ($1 == real(gap) && $2 == 20000 ? $4 : NaN):(100*($6/direct(real(gap))-1)):(200*$7/direct(real(gap))) \
     with yerrorbars pt 7 lc rgb (gap eq "0.3" ? first : second) title "gap ".gap
unset multiplot
