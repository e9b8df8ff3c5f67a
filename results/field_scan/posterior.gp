# gnuplot -c posterior.gp posterior.csv posterior.svg
call system("dirname ".ARG0)."/../look.gp" 330
set output ARG2
data = "< awk -F, 'NR > 1 { if ($1 != row && NR > 2) print \"\"; row = $1; print $1, $2, $3, $4 }' ".ARG1
eval text("posterior of the paper's forces, from Table IV", 8, 18)
eval text("lines: 50 and 95 % of it; cross: scenes/field.toml", 8, 42)." font ',12'"
eval panel(64, 484, 62, 268)
set xlabel "random force Rm (N)"
set ylabel "propulsion F_{prop} (N)"
eval "set palette defined ".sequential
unset colorbox
unset key
set ytics 1
set xtics 10
set contour base
set cntrparam levels discrete 0.5, 0.95
unset surface
set table $lines
splot data using 2:1:4
unset table
set autoscale fix
$scene << end
7 50
end
plot data using 2:1:3 with image, \
     $lines using 1:2 with lines lw 2 lc rgb "#ffffff", \
     $scene using 2:1 with points pt 2 ps 1.2 lw 3 lc rgb second
