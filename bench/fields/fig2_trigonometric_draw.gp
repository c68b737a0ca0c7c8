# SPDX-License-Identifier: MIT
# Three panels: the velocity, the error of plain SPH, the error of KGC. Of every particle, on the smallest
# lattice; `quantity` above is gradient or curl.
data = 'fields_'.field.'_'.lattice.'.csv'
d = 2.0 / side
name(k) = quantity.'_error_'.word(methods, k)
array largest[6]
do for [k = 1:6] {
    stats data using (column(name(k))) nooutput
    largest[k] = STATS_max
}
exponent(value) = int(floor(log10(value)))
text(value) = value == 0 ? '0' : exponent(value) >= -2 && exponent(value) < 3 ? sprintf('%.3g', value) \
    : sprintf('%.1f·10^{%d}', value / 10.0**exponent(value), exponent(value))

# Viridis (van der Walt, Smith 2015, matplotlib, CC0). Of fields computed exactly the error is rounding, 10 to 15
# decades below the plain one: the scale then starts under the rounding unit, and its lower third of colours
# covers all of that.
viridis = '#440154 #482878 #3e4a89 #31688e #26828e #1f9e89 #35b779 #6dcd59 #b4de2c #fde725'
rounding = field eq 'rotation'
decades = rounding ? (precision eq 'f64' ? 17 : 9) : 4
knee = rounding ? 1 - 2.5 / decades : 0.5 # the lower share of colours lies below it
share = rounding ? 0.35 : 0.5
position(c) = c <= share ? knee * c / share : knee + (1 - knee) * (c - share) / (1 - share)
colours = ''
do for [k = 0:9] {
    colours = colours.sprintf("%s%.4f '%s'", k > 0 ? ', ' : '', position(k / 9.0), word(viridis, k + 1))
}
eval 'set palette defined ('.colours.')'
least = rounding ? 10.0**(-decades) : 1e-3
set cbrange [least:rounding ? 1 : 3]
set logscale cb
set format cb '10^{%T}'
error(e) = e > least ? e : least

set xrange [-1:1]
set yrange [-1:1]
set size ratio -1
set xtics -1, 0.5
set ytics -1, 0.5
set tics out nomirror scale 0.5
set xlabel 'x' offset 0, 0.5
set ylabel 'y' offset 2.2, 0
unset key
set border lw 0.8
set style fill solid noborder
others = ''
do for [k = 3:6] {
    others = others.'  '.word(methods, k).' '.text(largest[k])
}
set label 1 lattice.' lattice, N = '.side.', H = '.support.' d, '.kernel.', '.precision.';  largest error of'.others \
    at screen 0.5, 0.035 center font ',11' textcolor '#444444'
set multiplot
unset colorbox

# Three squares, and room for the colour bar at the right.
place(panel) = sprintf('set lmargin at screen %.4f; set rmargin at screen %.4f', 0.05 + 0.305 * panel, 0.31 + 0.305 * panel)
set bmargin at screen 0.18
set tmargin at screen 0.863

eval place(0)
set title "velocity\n".formula offset 0, -0.5
every = (side + 13) / 14
start = (side - 1) % every / 2
shown(k) = int(k) % side % every == start && int(k) / side % every == start
arrow = every * d / 1.9
plot data using (shown($0) ? column('x') - arrow * column('vx') / 2 : NaN):(column('y') - arrow * column('vy') / 2) \
    :(arrow * column('vx')):(arrow * column('vy')) with vectors head filled size 0.045, 18 lw 1.4 lc '#31688e'

unset label 1
set ylabel ''
do for [panel = 1:2] {
    eval place(panel)
    set title quantity.' error of '.(panel == 1 ? 'plain SPH' : word(methods, panel))."\nat most ".text(largest[panel]) \
        offset 0, -0.5
    if (panel == 2) {
        set colorbox user origin 0.934, 0.18 size 0.013, 0.683
        set label 2 (quantity eq 'curl' ? '|curl_i - curl|' : '|J_i - J|_F') at screen 0.995, 0.93 right
    }
    if (jittered) {
        plot data using (column('x')):(column('y')):(0.5 * d):(error(column(name(panel)))) with circles lc palette
    } else {
        plot data using (column('x')):(column('y')):(error(column(name(panel)))) with image
    }
}
unset multiplot
