# SPDX-License-Identifier: MIT
# What a solver's author reads from the sweeps: KGC but for the last panel.
set output 'stability_reading.png'
set multiplot title 'KGC, H = '.support.' spacings, cubic spline, blend, eps = 0.01, but for what a panel changes'

eval place(0, 3, 0)
eval axis_threshold
set title 'what a larger eps costs: error of a linear field'
set ylabel 'mean |J_i - J| / |J|'
set yrange [0:*]
set key left top Left reverse samplen 2
plot for [k = 1:4] data using (at('threshold', word(policies, k), 'KGC', 'f32')):(positive('linear_mean')) \
    with lines lw number(policy_widths, k) lc rgb word(policy_colours, k) title word(policies, k)

eval place(1, 3, 0)
set title 'what a smaller eps costs: noise of a random field'
set ylabel 'largest |J_i| H, field in [-1, 1]'
set yrange [1:1e4]
set logscale y
set format y '10^{%T}'
set key right top
plot for [k = 1:4] data using (at('threshold', word(policies, k), 'KGC', 'f32')):(positive('noise')) \
    with lines lw number(policy_widths, k) lc rgb word(policy_colours, k) title word(policies, k)

eval place(2, 3, 0)
set title 'what a precision gives: rounding where rank is full'
set ylabel 'largest |J_i - J| / |J|, linear field'
set yrange [1e-16:1]
plot for [p = 1:3] data using (at('threshold', 'blend', 'KGC', word(precisions, p))):(positive('linear_full')) \
    with linespoints pt int(word(precision_points, p)) ps 0.9 lw 1.8 lc rgb word(precision_colours, p) title word(precisions, p)

eval place(3, 3, 0)
eval axis_offset
set title 'far from the origin: digits that positions lose'
set ylabel 'mean |J_i - J| / |J|, linear field'
set yrange [1e-17:10]
set key left top Left reverse samplen 2
plot for [p = 1:3] data using (at('offset', 'blend', 'KGC', word(precisions, p))):(positive('linear_mean')) \
    with linespoints pt int(word(precision_points, p)) ps 0.9 lw 1.8 lc rgb word(precision_colours, p) title word(precisions, p)

eval place(4, 3, 0)
eval axis_merging
set title 'two layers merge: how C jumps (uncorrected: C = 1)'
set ylabel 'largest change of C in a step of H / 1000'
set yrange [1e-4:1e6]
set key center top vertical maxrows 3 Right noreverse samplen 1.5 font ',10'
plot for [k = 1:4] data using (at('merging', word(policies, k), 'KGC', 'f64')):(positive('correction_jump')) \
        with lines lw number(policy_widths, k) lc rgb word(policy_colours, k) title word(policies, k), \
    for [k = 1:2] data using (at('merging', word(policies, k), 'KGC', 'f64')):(positive('correction_jump_left')) \
        with linespoints pt 6 ps 0.7 dt 3 lw 2 lc rgb word(policy_colours, k) title word(policies, k).', step / 256'

eval place(5, 3, 0)
eval axis_neighbours
set title 'few neighbours: error of a linear field'
set ylabel 'mean |J_i - J| / |J|'
unset logscale y
set format y '%g'
set yrange [0:1.2]
set key right top maxrows 6 samplen 2 font ',12'
plot for [m = 1:6] data using (at('neighbours', 'blend', word(methods, m), 'f32')):(column('linear_mean')) \
    with linespoints pt 7 ps 0.6 lw 1.8 lc rgb word(method_colours, m) title word(methods, m)
unset multiplot
