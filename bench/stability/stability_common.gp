# SPDX-License-Identifier: MIT
# What the three pictures of stability share. They read stability.csv; `support`, in spacings, and `machine`
# stand above.
set terminal pngcairo size 1600,900 font 'Sans,12' background '#ffffff'
set datafile separator ','
set datafile columnheaders
set datafile missing NaN
set encoding utf8
data = 'stability.csv'
set grid lc rgb '#dddddd'
set tics nomirror
set border 3

# Colour-blind-safe: Okabe, Ito 2008, "Color universal design".
methods = 'KGC MLS RKPM CMLS CRKPM SPH'
method_colours = '#0072B2 #009E73 #56B4E9 #D55E00 #E69F00 #999999'
policies = 'blend replace truncate identity'
policy_colours = '#0072B2 #D55E00 #E69F00 #009E73'
policy_widths = '2 7 4 1.3' # equal lines lie nested
precisions = 'f32 f64 mixed'
precision_colours = '#D55E00 #0072B2 #009E73'
precision_points = '7 4 8' # filled circle, open square, open triangle
number(list, k) = real(word(list, k))

# Where a panel stands, of two rows, the first at the upper left; room for a key below.
place(panel, columns, below) = sprintf('set lmargin at screen %.4f; set rmargin at screen %.4f; set tmargin at screen %.4f; set bmargin at screen %.4f', \
    (panel % columns + 0.18) / columns, (panel % columns + (columns == 4 ? 0.83 : 0.9)) / columns, \
    0.94 - (panel / columns + 0.09) * (0.94 - below) / 2, 0.94 - (panel / columns + 0.82) * (0.94 - below) / 2)

# The axis of each sweep. Zero has no place on a logarithmic axis: it is drawn where zero_... says.
sweeps = 'slab threshold offset scale neighbours volumes jitter merging'
decades = "set logscale x; set format x '10^{%T}'; "
numbers = "unset logscale x; set format x '%g'; "
axis_slab = "set title 'slab becomes thin'; set xlabel '(spacing / thickness)^2'; ".decades."set xrange [0.5:2e12]; set xtics 1, 1000"
axis_threshold = "set title 'threshold: block and wedge'; set xlabel 'eps'; ".decades."set xrange [5e-7:0.6]; set xtics autofreq"
axis_offset = "set title 'far from the origin'; set xlabel 'distance / H'; ".decades."set xrange [0.05:2e8]; set xtics 1, 100; set xtics add ('0' 0.1)"
axis_scale = "set title 'unit of length'; set xlabel 'k, all lengths times 2^k'; ".numbers."set xrange [-360:360]; set xtics -340, 170"
axis_neighbours = "set title 'number of neighbours'; set xlabel 'neighbours of a target'; set logscale x; set format x '%g'; set xrange [0.4:400]; set xtics (1, 3, 10, 30, 100, 300); set xtics add ('0' 0.5)"
axis_volumes = "set title 'uneven volumes'; set xlabel 'largest / smallest volume'; ".decades."set xrange [0.5:2e12]; set xtics 1, 1000"
axis_jitter = "set title 'disorder'; set xlabel 'jitter / spacing'; ".numbers."set xrange [-0.03:1.03]; set xtics 0, 0.25"
axis_merging = "set title 'two layers merge'; set xlabel 'distance of the layers / H'; ".numbers."set xrange [-0.03:1.13]; set xtics 0, 0.25"
zero_of(sweep) = sweep eq 'offset' ? 0.1 : sweep eq 'neighbours' ? 0.5 : 0

# The place of a row on the axis of its sweep, of one policy or, '', of all; NaN for other rows.
at(sweep, policy, method, precision) = strcol('sweep') eq sweep && strcol('method') eq method && \
    strcol('precision') eq precision && (policy eq '' || strcol('policy') eq policy) \
    ? (column('at') == 0 && zero_of(sweep) > 0 ? zero_of(sweep) : column('at')) : NaN
positive(name) = column(name) > 0 ? column(name) : NaN
