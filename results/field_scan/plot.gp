# gnuplot -c plot.gp scan.csv scan.svg
set terminal svg size 760,460 font "sans,13" background "#ffffff"
set output ARG2
set datafile separator ","
set title "How far the paper's Table IV lies from each scene\n(misfit; 8 on average if the scene were the paper's)"
set xlabel "random force Rm (N)"
set ylabel "propulsion F_{prop} (N)"
set palette defined (0 "#f7fbff", 1 "#9ecae1", 2 "#4292c6")
unset colorbox
set xtics 10 nomirror
set ytics 1 nomirror
set xrange [5:65]
set yrange [4.5:9.5]
unset key
plot ARG1 every ::1 using 2:1:(log10($3)) with image pixels, \
     "" every ::1 using 2:1:(sprintf("%.0f", $3)) with labels font ",13"
