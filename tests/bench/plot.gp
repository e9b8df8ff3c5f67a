# gnuplot -c plot.gp FOLDER: peers.svg and size.svg from the CSV files in FOLDER
folder = ARG1."/"
look = system("dirname ".ARG0)."/../../results/look.gp"
csv(name, filter) = sprintf("< awk -F, '%s' %s%s.csv", filter, folder, name)
set datafile separator ","
set format x "10^{%T}"

# A line of the file is a line of the figure.
call look 648
set output folder."peers.svg"
set multiplot
set logscale x
set grid xtics lt -1 lw 0.2
set ytics noenhanced scale 0 font ",12"
eval key_at(206, 26)
eval text("one gate, the same trials, one core", 8, 16)
eval panel(214, 490, 72, 292)
set xlabel "trials per second"
set xrange [1:1e5]
# As many lines as there are engines, and tools below: none is cut off.
stats csv("dynamics", "$1 == \"A\"") using 4 nooutput
set yrange [STATS_records-0.4:-0.6]
dot = "with points ps 0.9 lc rgb"
plot csv("dynamics", "$1 == \"A\"") using 4:($0-0.15):ytic(2) @dot first pt 7 title "A: propulsion 8 N, k 400/400 N m/rad", \
     csv("dynamics", "$1 == \"B\"") using 4:($0+0.15) @dot second pt 5 title "B: propulsion 7 N, k 300/500 N m/rad"
unset key
unset label
unset grid
eval text("the chain, the same answers", 8, 372)
eval panel(214, 452, 390, 580)
set xlabel "times as long as gatewalk's fastest"
set autoscale y
stats csv("chain", "NR > 1 && $7 > 1") using 7 nooutput
set yrange [STATS_records-0.4:-0.6]
plot csv("chain", "NR > 1 && $7 > 1 { gsub(\"gatewalk\", \"our\"); sub(\" rmarkovchain\", \"\"); print }") using 7:0:ytic(strcol(1).": ".strcol(3)) @dot first pt 7, \
     "" using ($7*1.5):0:(sprintf($7 < 100 ? "%.1f" : "%.0f", $7)) with labels left font ",12"
unset multiplot

reset
call look 616
set datafile separator ","
set output folder."size.svg"
set logscale xy
set format xy "10^{%T}"
set grid lt -1 lw 0.2
set style data linespoints
set pointsize 0.6
on(threads, what) = csv("size", sprintf("$1 == \"%s\" && $3 == %d", what, threads))
one(what) = on(1, what)
set multiplot
eval key_at(76, 32)
eval text("trials of one gate (A)", 76, 16)
eval panel(76, 238, 116, 256)
set xlabel "trials"
set ylabel "seconds"
set xrange [50:2e6]
plot one("trials stable") using 2:4 title "stable" lc rgb first pt 7, \
     one("trials moreau") using 2:4 title "moreau" lc rgb third pt 9, \
     on(2, "trials stable") using 2:4 title "stable, two threads" lc rgb first pt 6 dt 2, \
     on(2, "trials moreau") using 2:4 title "moreau, two threads" lc rgb third pt 8 dt 2
unset key
unset label
eval text("matrix, 100 runs/row", 326, 16)
eval panel(326, 488, 116, 256)
set xlabel "rows"
set xrange [3:2000]
plot one("rows") using 2:4 title "stable" lc rgb first pt 7
unset label
eval text("exact prediction", 76, 346)
eval key_at(76, 362)
eval panel(76, 238, 412, 552)
set xlabel "side of the field (gates)"
set ylabel "seconds"
set xrange [6:1500]
set xtics (9, 33, 101, 301, 1001) font ",12"
set format x "%g"
limited = "at most 13/9 of the side"
plot one("field no limit") using 2:4 title "any number of gates" lc rgb first pt 7, \
     one("field limited") using 2:4 title limited lc rgb second pt 5
unset key
unset label
eval text("its peak memory", 326, 346)
eval panel(326, 488, 412, 552)
set ylabel "MiB"
set yrange [10:*]
plot one("field no limit") using 2:5 lc rgb first pt 7, one("field limited") using 2:5 lc rgb second pt 5
unset multiplot
