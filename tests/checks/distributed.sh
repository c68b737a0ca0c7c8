#!/bin/sh
# SPDX-License-Identifier: MIT
# distributed.sh START PROGRAM [BROKEN_LIBRARY]: a program of examples/distributed agrees with one rank on every
# number of ranks, more than there are particles included, and fails where the exchange of corrections is
# forgotten or the library is broken (broken_library.c). START: the script
# that starts ranks.
start=$1 program=$2 wrapper=${3-}
status=0
output=$(mktemp) || exit 1
trap 'rm -f "$output"' EXIT

complain() {
    echo "$*:" >&2
    cat "$output" >&2
    status=1
}
# holds RANKS WORD...
holds() {
    ranks=$1
    shift
    "$start" "$ranks" "$program" "$@" >"$output" 2>&1 || complain "fails on $ranks ranks: $*"
    grep -q '[0-9]e[-+][0-9]' "$output" || complain "prints no error on $ranks ranks: $*"
}
# fails PATTERN RANKS WORD...: with these words in what it prints.
fails() {
    pattern=$1 ranks=$2
    shift 2
    "$start" "$ranks" "$@" >"$output" 2>&1 && complain "holds on $ranks ranks: $*"
    grep -q "$pattern" "$output" || complain "does not say '$pattern' on $ranks ranks: $*"
}
# fails_when_broken PATTERN WAY WORD...
fails_when_broken() {
    pattern=$1 way=$2
    shift 2
    [ -z "$wrapper" ] || fails "$pattern" 2 env BROKEN_LIBRARY="$way" LD_PRELOAD="$wrapper" "$program" "$@"
}

case $program in
    *forces)
        for ranks in 1 2 3 5; do
            holds "$ranks"
        done
        holds 5 1 # particle
        holds 4 slabs
        fails 'KGC.*WRONG' 3 "$program" forget
        fails_when_broken 'RKPM.*WRONG' zero
        fails_when_broken 'RKPM.*WRONG' hole
        fails '^mpirun -n' 1 "$program" many
        ;;
    *rotating_drop)
        holds 5 6 40 7
        holds 3 6 40 1000 slabs
        holds 5 1 3 # five particles
        fails_when_broken '^Wrong: the radius' zero 6 40
        fails_when_broken 'is not finite' hole 6 40
        fails '^mpirun -n' 1 "$program" 0
        ;;
esac
exit $status
