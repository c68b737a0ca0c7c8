# SPDX-License-Identifier: MIT
# Mean ranks as lines, and the share of particles that the eigensolver decides as marks.
set output 'stability_ranks.png'
dashes = '1 1 2 1 2' # of the lines; RKPM and CRKPM lie on others
marks = '7 7 6 7 6'

set multiplot title 'Fully corrected directions, and share of particles that the eigensolver decides (blend, eps = 0.01 but for the second panel, f32)'
set yrange [-0.1:3.1]
set ytics 0, 1
set border 11
set y2range [-3.333:103.333]
set y2tics 0, 25
set key at screen 0.88, screen 0.25 center center vertical samplen 4 spacing 1.4
shown = 'slab threshold offset neighbours volumes jitter merging' # no rank depends on the scale
do for [panel = 0:6] {
    sweep = word(shown, panel + 1)
    eval place(panel, 4, 0)
    eval value('axis_'.sweep)
    set ylabel (panel % 4 == 0 ? 'mean rank (lines)' : '') offset 1,0
    set y2label (panel % 4 == 3 || panel == 6 ? 'decomposed [%] (marks)' : '') offset -2.5,0
    plot for [m = 1:5] data using (at(sweep, 'blend', word(methods, m), 'f32')):(column('rank')) \
            with lines lw 2 dt int(word(dashes, m)) lc rgb word(method_colours, m) notitle, \
        for [m = 1:5] data using (at(sweep, 'blend', word(methods, m), 'f32')):(3 * column('decomposed')) \
            with points pt int(word(marks, m)) ps 0.8 lc rgb word(method_colours, m) notitle, \
        for [m = 1:panel == 6 ? 5 : 0] keyentry with linespoints pt int(word(marks, m)) lw 2 dt int(word(dashes, m)) \
            lc rgb word(method_colours, m) title word(methods, m)
}
unset multiplot
