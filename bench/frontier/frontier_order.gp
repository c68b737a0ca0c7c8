# SPDX-License-Identifier: MIT
# Order 2 beside order 1: two panels, the boundary and the inside. A line a way and H, its points ever finer cubes.
# Reads frontier_order.csv; `title` stands above.
set terminal pngcairo size 1400,720 font 'Sans,12' background '#ffffff'
set output 'frontier_order.png'
set datafile separator ','
set datafile columnheaders
set encoding utf8
data = 'frontier_order.csv'
array ways[4] = ['order 1', 'classic', 'order 2', 'order 2 lent']
array titles[4] = ['order 1', 'classic (CMLS)', 'order 2', 'order 2, borrowed curvature']
supports = '2 2.5 3'
colours = '#D55E00 #999999 #0072B2 #009E73' # Okabe, Ito 2008
marks = '7 5 9'
of(w, h) = strcol('way') eq ways[w] && column('support') == real(h) ? column('all_ms') : NaN

set logscale xy
set format y '10^{%T}'
set grid lc rgb '#dddddd'
set border 3
set tics nomirror
set xlabel 'time from positions to Jacobians, of the whole cube [ms]'
set key top right reverse Left samplen 2
set multiplot layout 1,2 title title
do for [panel = 0:1] {
    error = panel == 0 ? 'boundary_max' : 'inside_max'
    set title panel == 0 ? 'two outermost layers' : 'inside'
    set ylabel panel == 0 ? 'largest error of J' : ''
    plot for [w = 1:4] for [s = 1:3] data using (of(w, word(supports, s))):(column(error)) with linespoints \
        lw 1.8 dt s pt int(word(marks, s)) lc rgb word(colours, w) title titles[w].', H = '.word(supports, s)
}
unset multiplot
