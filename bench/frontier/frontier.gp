# SPDX-License-Identifier: MIT
# The frontier: two panels, every way a point, the frontier a line whose points are marked and named beneath.
# Reads frontier.csv and frontier_steps.csv; `title` stands above.
set terminal pngcairo size 1500,880 font 'Sans,12' background '#ffffff'
set output 'frontier.png'
set datafile separator ','
set datafile columnheaders
set encoding utf8
data = 'frontier.csv'
steps = 'frontier_steps.csv'
set tics nomirror

# Colour-blind-safe: Okabe, Ito 2008, "Color universal design".
methods = 'KGC MLS RKPM CMLS CRKPM SPH'
colours = '#0072B2 #009E73 #56B4E9 #D55E00 #E69F00 #999999'
precisions = 'f32 f64 mixed'
symbols = '6 4 8' # open circle, open square, open triangle

# So that a way that met a slow moment does not press the others together.
stats data using (log(column('ns_per_particle'))) nooutput
shortest = exp(STATS_min)
slow = 6 * exp(STATS_mean)
slow = slow > 3 * shortest ? slow : 3 * shortest
stats data using (column('trigonometric_mean')) nooutput
least = STATS_min
most = STATS_max

# Where a panel stands, and beneath it the names.
frame(panel, above, below) = sprintf('set lmargin at screen %.3f; set rmargin at screen %.3f; set tmargin at screen %.3f; set bmargin at screen %.3f', \
    0.07 + 0.5 * panel, 0.485 + 0.5 * panel, above, below)
ns(method, precision) = strcol('method') eq method && strcol('precision') eq precision ? column('ns_per_particle') : NaN
step(field, side) = strcol('field') eq field && strcol('side') eq side ? column('ns') : NaN
named = 14 # at most; the CSV has the rest
line = 0
below(field) = strcol('field') eq field ? (line = line + 1, line > named ? NaN : -line) : NaN
way(field) = strcol('mark').'   '.strcol('method').', '.strcol('kernel').', '.strcol('precision').', '.strcol('path').', '.strcol('option')

fields = 'trigonometric linear'
error_trigonometric = 'trigonometric_mean'
error_linear = 'linear_max'
axes_trigonometric = "set title 'trigonometric field, 20 spacings a wave'; set ylabel 'mean relative error of J'; " \
    ."set yrange [0.5*least:1.5*most]; set ytics nomirror (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)"
axes_linear = "set title 'linear field v = (-y, x, 2z)'; set ylabel 'largest relative error of J'; " \
    ."set yrange [*:10]; set ytics nomirror autofreq; set format y '10^{%T}'"

set multiplot title title."\nevery point one way: method, kernel, precision, path, option; " \
    ."black: the frontier, dashed: over lists that the host found"
do for [panel = 0:1] {
    field = word(fields, panel + 1)
    error = value('error_'.field)
    eval frame(panel, 0.87, 0.40)
    eval value('axes_'.field)
    set logscale xy
    set xrange [0.8 * shortest:slow]
    set grid lc rgb '#dddddd'
    set border 3
    set xlabel 'time from positions to Jacobians [ns a particle]'
    set xtics nomirror (10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000)
    set key at screen 0.5, screen 0.06 center center maxrows 3 font ',10'
    if (panel == 0) { unset key }
    plot for [m = 1:6] for [p = 1:3] data using (ns(word(methods, m), word(precisions, p))):(column(error)) \
            with points pt int(word(symbols, p)) ps 0.8 lw 1.2 lc rgb word(colours, m) \
            title word(methods, m).' '.word(precisions, p), \
        for [s = 1:2] steps using (step(field, word('search host', s))):(column('error')) \
            with steps lw 1.8 dt s lc rgb 'black' notitle, \
        for [s = 1:2] steps using (step(field, word('search host', s))):(column('error')) \
            with points pt 7 ps 0.7 lc rgb 'black' notitle, \
        for [s = 1:2] steps using (step(field, word('search host', s))):(column('error')):(strcol('mark')) \
            with labels offset -0.8,-0.8 font ',11' notitle

    unset logscale
    unset grid
    unset border
    unset tics
    unset key
    unset title
    unset xlabel
    unset ylabel
    eval frame(panel, 0.32, 0.09)
    set xrange [0:1]
    set yrange [-named - 0.5:0]
    line = 0
    plot steps using (0):(below(field)):(way(field)) with labels left font ',10' notitle
}
unset multiplot
