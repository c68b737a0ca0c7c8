#!/bin/sh
# SPDX-License-Identifier: MIT
# bench_ratios.sh PROGRAM CHECKER: leaving something out saves time. Ratios of processor times of
# one thread, measured in turn, the least of many rounds, with room for a busy machine; what disturbs
# one measurement of three does not disturb all.
set -eu
program=$1 checker=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

takes_at_most() {
    "$checker" "$work/report.json" ratio "skip/$2/this" "skip/$2/full" "$1" || status=1
}

measure() {
    status=0
    "$program" skip --particles 27000 --threads 1 --repetitions 11 --json "$work/report.json" \
        >/dev/null || exit 1
    takes_at_most 1.1 'outputs/divergence alone'
    takes_at_most 1.1 'outputs/curl alone'
    takes_at_most 1.1 'outputs/Jacobian, matrices not kept'
    takes_at_most 0.95 'outputs/matrices alone'
    takes_at_most 0.8 'fields/4 vector fields in one call'
    takes_at_most 0.8 'fields/the same with matrices given'
    takes_at_most 0.9 'active/50 % clustered, mask'
    takes_at_most 0.9 'active/50 % clustered, list'
    takes_at_most 0.8 'active/10 % scattered, mask'
    takes_at_most 0.6 'active/1 % scattered, mask'
    takes_at_most 0.6 'active/1 % scattered, list'
    takes_at_most 0.5 'active/10 % clustered, list'
    takes_at_most 0.25 'active/1 % clustered, list'
    takes_at_most 0.85 'reuse/neighbours kept'
    takes_at_most 0.85 'reuse/neighbours and matrices kept'
    takes_at_most 1 'reuse/a wall, targets_of'
    takes_at_most 0.95 'problem/2D, as many particles and pairs'
    takes_at_most 0.9 'problem/matrices that need no SVD'
    takes_at_most 1.15 'problem/one volume for all'
}

for attempt in 1 2 3; do
    printf 'measurement %d\n' "$attempt"
    measure
    [ "$status" -ne 0 ] || exit 0
done
exit 1
