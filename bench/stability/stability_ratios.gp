# SPDX-License-Identifier: MIT
# Largest error of a gradient over its bound: a panel for each sweep.
set output 'stability_ratios.png'
worse(a, b) = a > b ? a : b > 0 ? b : NaN
has(sweep, k) = k < 6 || (sweep ne 'threshold' && sweep ne 'merging') # plain SPH knows neither

set multiplot title "Largest error of a gradient over its bound, beside brute force in quadruple precision (H = ".support." spacings, ".machine.")\ndashed: 10, the limit at full rank; dotted: 16, the limit where the threshold acts; equal marks cover each other"
set logscale y
set yrange [1e-4:40]
set format y '10^{%T}'
set key at screen 0.5, screen 0.035 center center vertical maxrows 1 samplen 1.5 width 2
do for [panel = 0:7] {
    sweep = word(sweeps, panel + 1)
    eval place(panel, 4, 0.07)
    eval value('axis_'.sweep)
    set ylabel (panel % 4 == 0 ? 'error / bound' : '') offset 1.5,0
    keys = panel == 7 # of all panels
    plot 10 with lines lw 1.5 dt 2 lc rgb 'black' notitle, \
        16 with lines lw 1.5 dt 3 lc rgb 'black' notitle, \
        for [m = 1:has(sweep, 6) ? 6 : 5] for [p = 1:3] data \
            using (at(sweep, '', word(methods, m), word(precisions, p))):(worse(column('ratio_full'), column('ratio_touched'))) \
            with points pt int(word(precision_points, p)) ps 0.7 lc rgb word(method_colours, m) notitle, \
        for [m = 1:keys ? 6 : 0] keyentry with points pt 5 ps 1.4 lc rgb word(method_colours, m) title word(methods, m), \
        for [p = 1:keys ? 3 : 0] keyentry with points pt int(word(precision_points, p)) ps 1.1 lc rgb 'black' title word(precisions, p)
}
unset multiplot
