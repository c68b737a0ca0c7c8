#!/bin/sh
# SPDX-License-Identifier: MIT
# bench_options.sh PROGRAM: a bad option is answered by one line on stderr and exit status 2.
program=$1
status=0

refuses() {
    message=$("$program" "$@" 2>&1 >/dev/null)
    code=$?
    lines=$(printf '%s\n' "$message" | wc -l)
    if [ "$code" -ne 2 ] || [ -z "$message" ] || [ "$lines" -ne 1 ]; then
        echo "sphgrad-bench $*: exit status $code, on stderr: $message" >&2
        status=1
    fi
}

refuses --nonsense
refuses nonsense
refuses --particles
refuses --particles none
refuses --particles -8
refuses --threads 1.5
refuses --support 0
refuses --support nan
refuses --kernel gaussian
refuses --precision f16
refuses --order random
refuses --repetitions 0
refuses --jitter -1
refuses --input /dev/null --support 1 --output .
refuses --output /proc/nothing
refuses fields --input /nonexistent.csv
refuses fields --input /nonexistent.csv --support 1
refuses fields --mass 1
refuses fields --support 21
refuses --input /nonexistent.csv
refuses --isa sse9
refuses limit --support 1
refuses limit --isa neon-v9
refuses limit --threads 0
refuses limit --particles 1.5
refuses limit --json /nonexistent/report.json
refuses limit probe
refuses skip --jitter 2
refuses skip --nonsense
refuses frontier --output /proc/nothing
refuses frontier --particles 0
refuses scaling --full=yes
refuses scaling --support 100
refuses stability --sweep nothing
refuses stability --policy nothing
refuses stability --quick=yes
refuses stability --jitter 2
exit $status
