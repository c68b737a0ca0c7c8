# SPDX-License-Identifier: MIT
# Table 1 as bars: of each method what the paper measured, matrices under the gradient, and beside it the same here and
# both in one call. Reads table1.csv; `title` says of what, `threads` how many ran here.
set terminal pngcairo size 1200,520 font 'Sans,13' background '#ffffff'
set output 'table1.png'
set datafile separator ','
set datafile columnheaders
set encoding utf8
data = 'table1.csv'

# Colour-blind-safe: Okabe, Ito 2008, "Color universal design"; the paper's in grey.
paper_matrix = '#777777'
paper_gradient = '#bbbbbb'
matrix = '#0072B2'
gradient = '#56B4E9'
fused = '#E69F00'

methods = 'SPH KGC MLS RKPM CMLS CRKPM' # the linearised ones side by side, as one reads them
place(at) = 0.27 * at + sum [k = 1:6] (strcol('method') eq word(methods, k) ? k : 0)
number(key) = strcol(key) eq '' ? 0 : column(key) # plain SPH has no matrices
all(a, b) = number(a) + number(b)
figure(ms) = ms < 0.095 ? sprintf('%.2g', ms) : ms < 9.95 ? sprintf('%.1f', ms) : sprintf('%.0f', ms)

stats data using (strcol('method') eq 'KGC' ? number('fused_ms') : NaN) name 'HERE' nooutput
stats data using (strcol('method') eq 'KGC' ? all('paper_matrix', 'paper_gradient') : NaN) name 'PAPER' nooutput

set style fill solid noborder
set boxwidth 0.25
set border 3
set tics nomirror
set xrange [0.5:6.5]
set yrange [0:*]
set xtics ('plain SPH' 1, 'KGC' 2, 'MLS' 3, 'RKPM' 4, 'classic MLS' 5, 'classic RKPM' 6) scale 0
set ylabel 'time [ms]'
set grid y lc rgb '#eeeeee'
set key top left Left reverse samplen 1 spacing 1.15
set lmargin 9
set tmargin 5
set label 1 sprintf("KGC, matrices and gradient: %s ms on %d thread%s; the paper's: %.0f ms for a million on 32 cores", \
    figure(HERE_max), threads, threads > 1 ? 's' : '', PAPER_max) \
    at screen 0.5,0.95 center font 'Sans:Bold,16'
set label 2 title at screen 0.5,0.89 center font 'Sans,12' tc rgb '#555555'
plot data using (place(-1)):(all('paper_matrix', 'paper_gradient')) with boxes lc rgb paper_gradient title 'paper: gradient', \
    '' using (place(-1)):(number('paper_matrix')) with boxes lc rgb paper_matrix title 'paper: matrices', \
    '' using (place(0)):(all('matrix_ms', 'gradient_ms')) with boxes lc rgb gradient title 'sphgrad: gradient', \
    '' using (place(0)):(number('matrix_ms')) with boxes lc rgb matrix title 'sphgrad: matrices', \
    '' using (place(1)):(number('fused_ms') > 0 ? number('fused_ms') : NaN) with boxes lc rgb fused \
        title 'sphgrad: both in one call', \
    '' using (place(-1)):(all('paper_matrix', 'paper_gradient')):(figure(all('paper_matrix', 'paper_gradient'))) \
        with labels offset 0,0.6 font ',11' notitle, \
    '' using (place(0)):(all('matrix_ms', 'gradient_ms')):(figure(all('matrix_ms', 'gradient_ms'))) \
        with labels offset 0,0.6 font ',11' notitle, \
    '' using (place(1)):(number('fused_ms')):(number('fused_ms') > 0 ? figure(number('fused_ms')) : '') \
        with labels offset 0,0.6 font ',11' notitle
