# gnuplot -c plot.gp FOLDER: peers.svg and size.svg from the CSV files in FOLDER
folder = ARG1."/"
csv(name, filter) = sprintf("< awk -F, '%s' %s%s.csv", filter, folder, name)
set datafile separator ","
set border 3
set tics nomirror
set style fill solid
set terminal svg size 960,400 font "sans,12" background "#ffffff" enhanced
set output folder."peers.svg"

# Bars lie: a line of the file is a line of the figure.
set logscale x
set format x "10^{%T}"
set grid xtics lc "#dddddd" lt 1
set ytics noenhanced scale 0
set multiplot
set origin 0,0
set size 0.47,1
set lmargin at screen 0.19
set rmargin at screen 0.45
set title "One gate, the same trials:\ntrials per second of one core"
set key bottom right reverse Left invert
set xrange [1:*]
plot csv("dynamics", "$1 == \"A\"") using 4:0:(1):4:($0-0.4):($0):ytic(2) with boxxyerror title "A" lc "#0072b2", \
     csv("dynamics", "$1 == \"B\"") using 4:0:(1):4:($0):($0+0.4) with boxxyerror title "B" lc "#56b4e9"
set origin 0.47,0
set size 0.53,1
set lmargin at screen 0.74
set rmargin at screen 0.97
set title "The chain, the same answers:\ntimes as long as gatewalk's fastest"
set xrange [1:2e5]
unset key
plot csv("chain", "$7 > 1") using 7:0:(1):7:($0-0.35):($0+0.35):ytic(strcol(1).": ".strcol(3)) \
       with boxxyerror lc "#0072b2", \
     "" using ($7*1.2):0:(sprintf($7 < 100 ? "%.1f" : "%.0f", $7)) with labels left
unset multiplot

reset
set datafile separator ","
set grid lc "#dddddd" lt 1
set border 3
set tics nomirror
set terminal svg size 900,700 font "sans,12" background "#ffffff" enhanced
set output folder."size.svg"
set logscale xy
set format xy "10^{%T}"
set key top left reverse Left
set multiplot layout 2,2
on(threads, what) = csv("size", sprintf("$1 == \"%s\" && $3 == %d", what, threads))
one(what) = on(1, what)
set style data linespoints
set title "Trials of one gate (A)"
set xlabel "trials"
set ylabel "seconds"
set xrange [50:2e6]
set yrange [1e-3:1e4]
plot one("trials stable") using 2:4 title "stable" lc "#0072b2" pt 7, \
     one("trials moreau") using 2:4 title "moreau" lc "#009e73" pt 9, \
     on(2, "trials stable") using 2:4 title "stable, two threads" lc "#0072b2" pt 6 dt 2, \
     on(2, "trials moreau") using 2:4 title "moreau, two threads" lc "#009e73" pt 8 dt 2
set title "Matrix, 100 runs per row, one thread"
set xlabel "rows"
set xrange [3:2000]
set yrange [*:*]
plot one("rows") using 2:4 title "stable" lc "#0072b2" pt 7
set title "Exact prediction, one thread"
set xlabel "side of the field, gates"
set xrange [6:1500]
set xtics (9, 33, 101, 301, 1001)
set format x "%g"
limited = "at most 13/9 of the side"
plot one("field no limit") using 2:4 title "any number of gates" lc "#0072b2" pt 7, \
     one("field limited") using 2:4 title limited lc "#d55e00" pt 5
set title "Its peak memory, whole process"
set ylabel "MiB"
set yrange [10:*]
set format y "%g"
plot one("field no limit") using 2:5 title "any number of gates" lc "#0072b2" pt 7, \
     one("field limited") using 2:5 title limited lc "#d55e00" pt 5
unset multiplot
