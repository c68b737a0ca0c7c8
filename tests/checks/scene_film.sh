#!/bin/sh
# SPDX-License-Identifier: MIT
# scene_film.sh PROGRAM SCENE DIR: the gates of a scene hold, and the same run leaves the frames of a film: of each
# method a table for each, and, where there is gnuplot, a picture for each.
program=$1 scene=$2 directory=$3
status=0

complain() {
    echo "$*" >&2
    status=1
}

rm -rf "$directory"
"$program" --check --frames 2 --output "$directory" || complain "a gate fails, or the scene"
for frame in 0000 0001; do
    for method in sph kgc; do
        set -- "$directory/${scene}_${method}_"*"_$frame.dat"
        [ -s "$1" ] || complain "no table for frame $frame of $method"
    done
    if ! command -v gnuplot >/dev/null 2>&1; then
        echo "skipped: no gnuplot, so no picture of frame $frame"
    elif [ ! -s "$directory/${scene}_$frame.png" ]; then
        complain "no picture of frame $frame"
    fi
done
cmp -s "$directory/${scene}_0000.png" "$directory/${scene}_0001.png" && complain "both frames are the same picture"
exit $status
