# SPDX-License-Identifier: MIT
# The frontier: time from positions to gradients against error, on a wavy field and on a linear one. Every way is a grey
# dot; left out are those over a host's lists, which need no search. Few are marked and named: of each method in f32, and
# of KGC in f64, the fastest whose error on the wavy field is within 5 % of the least.
# Reads frontier.csv, whose rows stand in the order of their times; `title` says of what.
set terminal pngcairo size 1200,600 font 'Sans,13' background '#ffffff'
set output 'frontier.png'
set datafile separator ','
set datafile columnheaders
set encoding utf8
data = 'frontier.csv'
set datafile missing NaN # what a line leaves out does not break it

# ---- The ways that are marked ------------------------------------------------------------------------

# Colour-blind-safe: Okabe, Ito 2008, "Color universal design".
linearised = '#0072B2'
classic = '#D55E00'
plain = '#000000'
methods = 'KGC MLS RKPM CMLS CRKPM SPH KGC'
precisions = 'f32 f32 f32 f32 f32 f32 f64'
points = '7 7 7 5 5 9 6' # discs, squares, a triangle, a circle
colours = linearised.' '.linearised.' '.linearised.' '.classic.' '.classic.' '.plain.' '.linearised
array time[7]
array wavy[7]
array linear[7]
searches(x) = strcol('path') ne "host's lists" ? x : NaN
fits(k) = strcol('method') eq word(methods, k) && strcol('precision') eq word(precisions, k) \
    && strcol('path') ne "host's lists"
see_least(k) = fits(k) && column('trigonometric_mean') < least ? (least = column('trigonometric_mean'), 0) : 0
see_fastest(k) = fits(k) && column('trigonometric_mean') <= 1.05 * least && column('ns_per_particle') < time[k] \
    ? (time[k] = column('ns_per_particle'), wavy[k] = column('trigonometric_mean'), linear[k] = column('linear_max'), 0) : 0
do for [k = 1:7] {
    least = 1e300
    time[k] = 1e300
    stats data using (see_least(k)) nooutput
    stats data using (see_fastest(k)) nooutput
}
smaller(a, b) = a < b ? a : b
larger(a, b) = a > b ? a : b
ratio(a, b) = sprintf('%.1f', time[a] / time[b])
times = ratio(4, 1).(ratio(4, 1) eq ratio(5, 1) ? '' : ' and '.ratio(5, 1)).' times'

# ---- Panels ------------------------------------------------------------------------------------------

error(field) = column(field eq 'linear' ? 'linear_max' : 'trigonometric_mean')
edge(field, x) = column(field.'_frontier') == 1 ? searches(x) : NaN
panel(k) = sprintf('set lmargin at screen %.3f; set rmargin at screen %.3f; set tmargin at screen 0.81; set bmargin at screen 0.12', \
    0.08 + 0.5 * k, 0.485 + 0.5 * k)
fields = 'trigonometric linear'
do for [k = 1:2] { # before there are ranges, outside which nothing would be counted
    stats data using (edge(word(fields, k), column('ns_per_particle'))) name word(fields, k).'_ns' nooutput
    stats data using (edge(word(fields, k), error(word(fields, k)))) name word(fields, k).'_error' nooutput
}
stats data using (searches(column('ns_per_particle'))) nooutput
set logscale xy
set xrange [0.8 * STATS_min:4.2 * time[1]] # what is slower is worth no room
set xtics nomirror (10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 700, 1000, 1500, 2000, 3000, 5000, 10000)
set xlabel 'search and gradients [ns a particle]'
set border 3
set grid lc rgb '#eeeeee'
unset key
set label 100 (time[1] < 1.05 * time[6] ? 'Correction costs no time that shows' : \
    'KGC takes '.ratio(1, 6).' times as long as plain SPH').sprintf(', and errors are %.1f times smaller', wavy[6] / wavy[1]) \
    at screen 0.5,0.955 center font 'Sans:Bold,16'
set label 101 title.'; each grey dot is a method, kernel, precision and path' \
    at screen 0.5,0.905 center font 'Sans,12' tc rgb '#555555'

set multiplot
do for [k = 0:1] {
    field = word(fields, k + 1)
    eval panel(k)
    do for [m = 1:6 + k] {
        set label m '' at time[m], (k ? linear[m] : wavy[m]) point pt int(word(points, m)) ps 1.8 lw 2.5 \
            lc rgb word(colours, m) front
    }
    if (k == 0) {
        set title 'wavy field, 20 spacings a wave'
        set ylabel 'mean relative error'
        set yrange [0.65 * wavy[1]:3.5 * wavy[6]]
        set ytics nomirror (0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.5, 1)
        set label 11 sprintf("{/:Bold KGC, MLS, RKPM}\n%.0f to %.0f ns", smaller(time[1], smaller(time[2], time[3])), \
            larger(time[1], larger(time[2], time[3]))) at 0.97 * time[1], 0.88 * wavy[1] left tc rgb linearised front
        set label 12 "{/:Bold classic MLS and RKPM}\n".times.' as long'.(wavy[4] < 0.95 * wavy[1] ? '' : ', no better') \
            at time[4], 1.75 * wavy[4] left tc rgb classic front
        set label 13 sprintf("{/:Bold plain SPH}\n%.0f ns, %.1f times the error", time[6], wavy[6] / wavy[1]) \
            at 1.06 * time[6], 0.94 * wavy[6] left tc rgb plain front
        set label 14 'the line: nothing is both faster and nearer' \
            at graph 0.99, graph 0.96 right font 'Sans,11' tc rgb '#777777' front
    } else {
        set title 'linear field: corrected gradients are exact up to rounding'
        set ylabel 'largest relative error'
        set yrange [1e-17:1e3]
        set ytics nomirror 1e-16,100,1
        set format y '10^{%T}'
        set label 11 "{/:Bold KGC, MLS,}\n{/:Bold RKPM}" at 0.97 * time[1], 0.04 * linear[1] left tc rgb linearised front
        set label 12 '{/:Bold classic MLS and RKPM}' at time[4], 25 * linear[4] left tc rgb classic front
        set label 13 '{/:Bold plain SPH}' at 0.97 * time[6], 30 * linear[6] left tc rgb plain front
        set label 14 '{/:Bold KGC in f64}: '.ratio(7, 1).' times as long' at 1.02 * time[7], 90 * linear[7] \
            left font 'Sans,13' tc rgb linearised front
    }
    set arrow 1 from first value(field.'_ns_min'), graph 1 to first value(field.'_ns_min'), first value(field.'_error_max') \
        nohead lw 2 lc rgb '#999999'
    set arrow 2 from first value(field.'_ns_max'), first value(field.'_error_min') to graph 1, first value(field.'_error_min') \
        nohead lw 2 lc rgb '#999999'
    plot data using (searches(column('ns_per_particle'))):(error(field)) with points pt 7 ps 0.4 lc rgb '#c0c0c0', \
        data using (edge(field, column('ns_per_particle'))):(error(field)) with steps lw 2 lc rgb '#999999'
}
unset multiplot
