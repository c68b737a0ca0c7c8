#!/bin/sh
# SPDX-License-Identifier: MIT
# openmp_wanted.sh CMAKE SOURCES COMPILER: without OpenMP in reach, a build that asks for it stops, one
# that leaves it open warns, one that does without is silent.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

configure() {
    "$1" -S "$2" -B "$work/build" -DCMAKE_C_COMPILER="$3" -DCMAKE_DISABLE_FIND_PACKAGE_OpenMP=ON \
        -DSPHG_BUILD_TESTS=OFF -DSPHG_BUILD_BENCH=OFF -DSPHG_BUILD_EXAMPLES=OFF \
        -DSPHG_OPENMP="$4" >"$work/output" 2>&1
}

if configure "$1" "$2" "$3" ON; then
    echo "a build with OpenMP asked for and not found goes on" >&2
    exit 1
fi
grep -q 'finds no OpenMP' "$work/output"
configure "$1" "$2" "$3" AUTO
grep -q 'CMake Warning' "$work/output"
grep -q 'finds no OpenMP' "$work/output"
configure "$1" "$2" "$3" OFF
! grep -q 'OpenMP' "$work/output"
