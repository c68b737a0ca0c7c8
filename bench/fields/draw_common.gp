# SPDX-License-Identifier: MIT
# What the pictures of fields share. Above stand, as strings: `output`, `field`, `formula`, `lattice`, `support`
# (in spacings), `kernel`, `precision`; and the number `side`, N of the smallest lattice.
set terminal pngcairo size 1260,480 font 'Sans,12' background '#ffffff'
set output output
set datafile separator ','
set datafile columnheaders
set encoding utf8
methods = 'SPH KGC MLS RKPM CMLS CRKPM'
jittered = lattice eq 'jittered'
