# call "look.gp" HEIGHT: the sheet of the program's figures (cli/render/figure.h), printed 3.5 inches wide,
# HEIGHT points high, for scripts that draw results; their colours, and places in points.
sheet_height = real(ARG1)
eval sprintf("set terminal svg size 504,%d font 'sans,15' background '#ffffff' enhanced", sheet_height)
first = "#0072b2"; second = "#d55e00"; third = "#009e73"; fourth = "#cc79a7"
sequential = "(0 '#440154', 1 '#46327e', 2 '#365c8d', 3 '#277f8e', 4 '#1fa187', 5 '#4ac16d', 6 '#a0da39', 7 '#fde725')"
at(left, top) = sprintf("%g,%g", left / 504., 1 - top / sheet_height)
text(words, left, middle) = sprintf("set label \"%s\" at screen %s left", words, at(left, middle))
panel(left, right, top, bottom) = sprintf("set lmargin at screen %g; set rmargin at screen %g; ", left / 504., right / 504.). \
  sprintf("set tmargin at screen %g; set bmargin at screen %g", 1 - top / sheet_height, 1 - bottom / sheet_height)
# A key of one column from this corner, written small.
key_at(left, top) = sprintf("set key at screen %s left top Left reverse vertical maxcols 1 samplen 1.5 spacing 1.1 font ',12'", at(left, top))
set border 3
set tics out nomirror scale 0.5
set xtics offset 0,0.5
set ytics offset 0.4,0
set xlabel offset 0,0.9
set ylabel offset 0.8,0
