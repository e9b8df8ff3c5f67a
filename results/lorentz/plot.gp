# gnuplot -c plot.gp lorentz.csv leaves.csv lorentz.svg
call system("dirname ".ARG0)."/../look.gp" 524
set output ARG3
set datafile separator ","
set multiplot
set grid lt -1 lw 0.2
set pointsize 0.5
set errorbars 0.5
unset mytics
eval text("What must a chain remember?", 8, 16)
eval text("diffusion, as a multiple of that of hops without memory", 8, 40)
eval panel(64, 494, 56, 246)
eval key_at(70, 60)
set xrange [0.03:0.32]
set xtics 0.05
set yrange [0.75:1.5]
set ytics 0.2
set xlabel "gap between discs of radius 1"
plot ARG1 every ::1 using 1:(1) with lines lw 2 lc rgb fourth title "no memory (Machta, Zwanzig)", \
     "" every ::1 using 1:($5/$2) with lines lw 2 lc rgb second title "one step of memory", \
     "" every ::1 using 1:($7/$2):(2*$8/$2) with yerrorbars pt 4 ps 0.9 lc rgb third title "direct simulation, 95 %", \
     "" every ::1 using 1:($9/$2):($10/$2):($11/$2) with yerrorbars pt 7 lc rgb first title "chain of trees, 95 %"
unset label
eval text("the chain less direct simulation, per cent, 2 standard errors", 8, 316)
eval panel(64, 494, 332, 474)
eval key_at(380, 396)
set logscale x 2
set xrange [2.2:50000]
set xtics (4, 32, 256, "2048" 2048, "16 384" 16384)
set yrange [-13:3]
set ytics 4
set xlabel "states of the chain, of the same 20 000 trials"
direct(gap) = real(system(sprintf("awk -F, '$1 == %s {print $7}' %s", gap, ARG1)))
colour(gap) = gap eq "0.05" ? first : gap eq "0.2" ? second : third
# Side by side, each a little off its place.
plot for [gap in "0.05 0.2 0.3"] d = direct(gap) ARG2 every ::1 \
     using ($1 == real(gap) && $2 == 20000 ? $4 * (1 + 2 * (real(gap) - 0.2)) : NaN):(100*($6/d-1)):(200*$7/d) \
     with yerrorbars pt 7 lc rgb colour(gap) title "gap ".gap
unset multiplot
