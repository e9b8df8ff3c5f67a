# gnuplot -c plot.gp scan.csv scan.svg
call system("dirname ".ARG0)."/../look.gp" 330
set output ARG2
set datafile separator ","
eval text("misfit of the paper's Table IV; 8 if the scene were the paper's", 8, 18)
eval text("colours: its logarithm", 8, 42)." font ',12'"
eval panel(64, 496, 62, 268)
set xlabel "random force Rm (N)"
set ylabel "propulsion F_{prop} (N)"
eval "set palette defined ".sequential
unset colorbox
unset key
set xrange [5:65]
set yrange [4.5:9.5]
set ytics 1
# White on the dark half of the colours, black on the light one.
plot ARG1 every ::1 using 2:1:(5):(0.5):(log10($3)) with boxxyerror fs solid noborder lc palette, \
     "" every ::1 using 2:1:(sprintf("%.0f", $3)):($3 > 120 ? 0x000000 : 0xffffff) with labels tc rgb variable
