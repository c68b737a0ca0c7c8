# SPDX-License-Identifier: MIT
# Scaling: a panel each for sizes, threads, neighbours, and for clouds and orders.
# Reads scaling.csv; `title` and `threads` stand above.
set terminal pngcairo size 1400,1000 font 'Sans,12' background '#ffffff'
set output 'scaling.png'
set datafile separator ','
set datafile columnheaders
set encoding utf8
data = 'scaling.csv'
set grid lc rgb '#dddddd'
set tics nomirror
set border 3
set datafile missing NaN

# Colour-blind-safe: Okabe, Ito 2008, "Color universal design".
works = 'search matrices gradient fused'
colours = '#999999 #0072B2 #009E73 #D55E00'
ns(k) = column(word(works, k).'_ns_per_particle')
is(group) = strcol('group') eq group
array single[4]
do for [k = 1:4] {
    stats data using (is('threads') && column('case_threads') == 1 ? ns(k) : NaN) nooutput
    single[k] = STATS_min
}

set multiplot layout 2,2 title title
set ylabel 'time [ns a particle]'
set yrange [0:*]

set title 'number of particles'
set logscale x
set format x '10^{%T}'
set xlabel 'particles'
set key right top
plot for [k = 1:4] data using (is('particles') ? column('particles') : NaN):(ns(k)) \
    with linespoints pt 7 ps 0.8 lw 1.6 lc rgb word(colours, k) title word(works, k)

set title 'threads'
unset logscale x
set format x '%g'
set xlabel 'threads'
set ylabel 'speed-up'
set xrange [1:threads > 1 ? threads : 2]
set key left top
plot x with lines lw 1 dt 2 lc rgb 'black' title 'ideal', \
    for [k = 1:4] data using (is('threads') ? column('case_threads') : NaN):(single[k] / ns(k)) \
    with linespoints pt 7 ps 0.8 lw 1.6 lc rgb word(colours, k) title word(works, k)

set title 'neighbours in 3D'
set xrange [0:*]
set xlabel 'pairs a particle'
set ylabel 'time [ns a particle]'
plot for [k = 1:4] data using (is('neighbours') && column('dimension') == 3 ? column('pairs_per_particle') : NaN):(ns(k)) \
    with linespoints pt 7 ps 0.8 lw 1.6 lc rgb word(colours, k) title word(works, k)

# Labels by the number of their column: by name gnuplot 5.4 cuts them at commas.
set title 'order in memory, and shape of the cloud'
unset xlabel
set xrange [*:*]
set style data histograms
set style histogram clustered gap 1
set xtics rotate by -25
set key right top
set rmargin 9
plot for [k = 1:4] '< grep -E "^(group|order|cloud)," scaling.csv' using (ns(k)):xtic(2) \
    with histograms fs solid 0.85 lc rgb word(colours, k) title word(works, k)
unset multiplot
