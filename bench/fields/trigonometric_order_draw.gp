# SPDX-License-Identifier: MIT
# Order 2 beside order 1: the largest gradient error of the trigonometric field over N, at the boundary and inside.
data = 'fields_convergence.csv'
array names[4] = ['SPH', 'KGC', 'KGC order 2', 'KGC order 2 lent']
array titles[4] = ['plain SPH', 'KGC, order 1', 'order 2', 'order 2, borrowed curvature']
colours = '#000000 #d55e00 #0072b2 #009e73'
marks = '5 7 9 11'
of(k) = strcol('lattice') eq lattice && strcol('field') eq 'trigonometric' && strcol('method') eq names[k]
abscissa(k) = of(k) ? column('N') * 1.02**(k - 3) : NaN # equal curves stand side by side
stats data using (of(2) && column('N') == side ? column('boundary_max') : NaN) nooutput
guide = 0.6 * STATS_max

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
do for [panel = 0:1] {
    set lmargin at screen 0.075 + 0.485 * panel
    set rmargin at screen 0.495 + 0.485 * panel
    set title panel == 0 ? 'two outermost layers' : 'inside'
    error = panel == 0 ? 'boundary_max' : 'inside_max'
    plot guide * side / x with lines dt 2 lc '#888888' lw 1.5 title 'falls as d', \
        guide * (side / x)**2 with lines dt 3 lc '#888888' lw 1.5 title 'falls as d^2', \
        for [k = 1:4] data using (abscissa(k)):(column(error)) with linespoints lw 1.4 \
            lc rgb word(colours, k) pt int(word(marks, k)) ps 1.2 title titles[k]
    set ylabel ''
    unset label 1
    unset key
}
unset multiplot
