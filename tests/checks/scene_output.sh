#!/bin/sh
# SPDX-License-Identifier: MIT
# scene_output.sh PROGRAM DIR [READER]: a scene (vorticity) prints a line of metrics per method, refuses
# bad options, and leaves tables, particles and, where there is gnuplot, a picture in its output directory.
program=$1 directory=$2 reader=$3
status=0

complain() {
    echo "$*" >&2
    status=1
}

refuses() {
    "$program" "$@" >/dev/null 2>&1
    code=$?
    [ "$code" -eq 2 ] || complain "vorticity $*: exit status $code instead of 2"
}

refuses --nonsense
refuses nonsense
refuses --method gaussian
refuses --size huge
refuses --seed x
refuses --threads -1
refuses --output /dev/null
refuses --check --alone
refuses --brief --output "$directory"
refuses --frames 2
refuses --frames 2 --output "$directory"
refuses --frames 1 --output "$directory"

rm -rf "$directory"
lines=$("$program" --method mls --seed 7 --output "$directory") || complain "the scene failed"
[ "$(printf '%s\n' "$lines" | grep -c '^{"scene": "vorticity", "method": "\(sph\|mls\)", .*"seed": 7, .*}$')" -eq 2 ] ||
    complain "not a line of metrics for each method: $lines"
without_seconds() { printf '%s\n' "$1" | sed 's/"seconds": [^}]*//'; }
in_turn=$("$program" --method mls --seed 7 --threads 1) || complain "the scene failed in turn"
[ "$(without_seconds "$lines")" = "$(without_seconds "$in_turn")" ] ||
    complain "side by side: $lines, in turn: $in_turn"
for method in sph mls; do
    [ -s "$directory/vorticity_${method}_spin.dat" ] || complain "no table for $method"
    if [ -n "$reader" ]; then
        "$reader" "$directory/vorticity_${method}_0000.vtkhdf" spin 2 || complain "particles of $method"
        grep -qxF "{\"name\": \"vorticity_${method}_0000.vtkhdf\", \"time\": 2}" \
            "$directory/vorticity_${method}_particles.vtkhdf.series" || complain "no time of the particles of $method"
    fi
done
mkdir "$directory/obstacle" "$directory/obstacle/vorticity_sph_spin.dat"
"$program" --output "$directory/obstacle" >/dev/null 2>&1 && complain "a method failed, the scene did not"
if command -v gnuplot >/dev/null 2>&1; then
    [ -s "$directory/vorticity.png" ] || complain "no picture"
    rm -f "$directory/vorticity.png"
    "$program" --method sph --output "$directory" >/dev/null || complain "plain SPH alone failed"
    [ ! -e "$directory/vorticity.png" ] || complain "a picture with nothing beside plain SPH"
fi
exit $status
