# SPDX-License-Identifier: MIT
# Order 2 beside order 1: two panels, the boundary and the inside. A line a way and H, its points ever finer cubes,
# the finest with H beside it. Reads frontier_order.csv; `title` stands above.
set terminal pngcairo size 1400,720 font 'Sans,13' background '#ffffff'
set output 'frontier_order.png'
set datafile separator ','
set datafile columnheaders
set datafile missing NaN
set encoding utf8
data = 'frontier_order.csv'
array ways[4] = ['order 1', 'classic', 'order 2', 'order 2 lent']
array titles[4] = ['order 1', 'order 1, classic (CMLS)', 'order 2', 'order 2, curvature lent']
supports = '2 2.5 3'
colours = '#D55E00 #999999 #0072B2 #009E73' # Okabe, Ito 2008
marks = '7 5 9 11'
ms(w, h) = strcol('way') eq ways[w] && column('support') == real(h) ? column('all_ms') : NaN
stats data using (column('side')) nooutput
finest = STATS_max
coarsest = STATS_min
last(w, h) = column('side') == finest ? ms(w, h) : NaN

stats data using (column('all_ms')) nooutput
slow = STATS_max
fast = STATS_min
stats data using (column('boundary_max')) nooutput
outside = STATS_min
stats data using (column('inside_max')) nooutput
set logscale xy
set xrange [0.7 * fast:2 * slow]
set format y '10^{%T}'
set grid lc rgb '#dddddd'
set border 3
set tics nomirror
set xlabel 'time of the whole cube, from positions to Jacobians [ms]'
set key bottom left reverse Left samplen 2 spacing 1.2
set multiplot layout 1,2 margins 0.07,0.98,0.11,0.82 spacing 0.07 title title."\n" \
    .sprintf('each line from %d^3 to %d^3 particles in one cube: lower and further left is better; numbers: H in spacings', \
             coarsest, finest)
do for [panel = 0:1] {
    error = panel == 0 ? 'boundary_max' : 'inside_max'
    set yrange [0.7 * (panel == 0 ? outside : STATS_min):*]
    set title panel == 0 ? 'two outermost layers' : 'inside'
    set ylabel panel == 0 ? 'largest error |J_i - J|_F' : ''
    plot for [w = 1:4] for [h in supports] data using (ms(w, h)):(column(error)) with linespoints \
            lw 1.8 pt int(word(marks, w)) ps 1.1 lc rgb word(colours, w) title h eq '2' ? titles[w] : '', \
        for [w = 1:2] for [h in supports] data using (last(w, h)):(column(error)):(h) with labels left \
            offset 0.8,0.2 textcolor rgb word(colours, w) font ',12' notitle, \
        for [h in supports] data using (last(3, h)):(column(error)):(h) with labels left \
            offset 0.4,0.7 textcolor rgb word(colours, 3) font ',12' notitle, \
        for [h in supports] data using (last(4, h)):(column(error)):(h) with labels left \
            offset 0.4,-0.7 textcolor rgb word(colours, 4) font ',12' notitle
    unset key
}
unset multiplot
