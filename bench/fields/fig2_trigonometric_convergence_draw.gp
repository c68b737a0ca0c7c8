# SPDX-License-Identifier: MIT
# The largest gradient error of the trigonometric field over N, at the boundary and inside.
data = 'fields_convergence.csv'
of(m) = strcol('lattice') eq lattice && strcol('field') eq 'trigonometric' && strcol('method') eq m
# Okabe, Ito 2008: eight colours that everyone can tell apart. The curves of the corrected methods nearly
# coincide: their marks stand side by side, shifted, instead of over each other.
colours = '#000000 #d55e00 #0072b2 #009e73 #cc79a7 #e69f00'
shifts = '0 -2 -1 0 1 2'
marks = '5 7 9 11 13 15'
sizes = '1.1 1.1 1.2 1.2 1.2 1.1'
abscissa(k) = of(word(methods, k)) ? column('N') * 1.025**real(word(shifts, k)) : NaN

# Guides fall as the corrected methods do.
smallest(name) = of('KGC') && column('N') == side ? column(name) : NaN
stats data using (smallest('boundary_max')) nooutput
boundary_guide = 0.55 * STATS_max
stats data using (smallest('inside_max')) nooutput
inside_guide = 0.55 * STATS_max
inside_order = jittered ? 1 : 2

set logscale xy
set xrange [0.8 * side:5.0 * side]
set xtics (side, 2 * side, 4 * side)
set yrange [2e-4:4]
set format y '10^{%T}'
set grid ytics lc '#dddddd'
set key bottom left reverse Left vertical maxrows 7 samplen 3 spacing 1.15
set tics nomirror
set bmargin at screen 0.19
set tmargin at screen 0.92
set xlabel 'N (N x N particles, spacing d = 2 / N)' offset 0, 0.3
set label 1 formula.', '.lattice.' lattice, H = '.support.' d, '.kernel.', '.precision.'; equal curves drawn side by side' \
    at screen 0.5, 0.035 center font ',11' textcolor '#444444'
set multiplot
set ylabel 'largest gradient error |J_i - J|_F' offset 0.5, 0

set lmargin at screen 0.075
set rmargin at screen 0.495
set title 'two outermost layers'
plot boundary_guide * side / x with lines dt 2 lc '#888888' lw 1.5 title 'falls as d', \
    for [k = 1:6] data using (abscissa(k)):(column('boundary_max')) with linespoints lw 1.2 \
        lc rgb word(colours, k) pt int(word(marks, k)) ps real(word(sizes, k)) title word(methods, k)

unset label 1
set ylabel ''
set lmargin at screen 0.560
set rmargin at screen 0.980
set title 'inside'
plot inside_guide * (side / x)**inside_order with lines dt 2 lc '#888888' lw 1.5 \
        title 'falls as d'.(inside_order == 2 ? '^2' : ''), \
    for [k = 1:6] data using (abscissa(k)):(column('inside_max')) with linespoints lw 1.2 \
        lc rgb word(colours, k) pt int(word(marks, k)) ps real(word(sizes, k)) notitle
unset multiplot
