#!/bin/sh
# SPDX-License-Identifier: MIT
# wanted.sh CMAKE SOURCES COMPILER: a binding that is asked for by name and cannot be built is an error; one that is
# AUTO is left out with a word.
set -eu
cmake=$1 sources=$2 compiler=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
log=$work/log

# configured OPTION...: without any other part, a static library, and no Fortran compiler.
configured() {
    rm -rf "$work/build"
    "$cmake" -S "$sources" -B "$work/build" -DCMAKE_C_COMPILER="$compiler" -DBUILD_SHARED_LIBS=OFF \
        -DCMAKE_Fortran_COMPILER=NOTFOUND -DSPHG_OPENMP=OFF -DSPHG_COMPILER_HAS_V3=OFF \
        -DSPHG_COMPILER_HAS_V4=OFF -DSPHG_BUILD_TESTS=OFF -DSPHG_BUILD_BENCH=OFF -DSPHG_BUILD_EXAMPLES=OFF \
        "$@" >"$log" 2>&1
}
says() {
    tr '\n' ' ' <"$log" | tr -s ' ' | grep -qF "$1" || { cat "$log" >&2; echo "not said: $1" >&2; exit 1; }
}

configured -DSPHG_BUILD_PYTHON=AUTO -DSPHG_BUILD_FORTRAN=AUTO || { cat "$log" >&2; exit 1; }
says 'sphgrad: the Python package is left out: Python loads the shared library'
says 'sphgrad: the Fortran module is left out: there is no Fortran compiler'
! configured -DSPHG_BUILD_PYTHON=ON -DSPHG_BUILD_FORTRAN=OFF
says 'sphgrad: SPHG_BUILD_PYTHON is ON, but Python loads'
! configured -DSPHG_BUILD_PYTHON=OFF -DSPHG_BUILD_FORTRAN=ON
says 'sphgrad: SPHG_BUILD_FORTRAN is ON, but there is no'
configured -DSPHG_BUILD_PYTHON=OFF -DSPHG_BUILD_FORTRAN=OFF
! grep -q 'left out' "$log"
