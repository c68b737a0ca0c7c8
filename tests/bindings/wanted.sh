#!/bin/sh
# SPDX-License-Identifier: MIT
# wanted.sh CMAKE SOURCES COMPILER: a binding that is asked for by name and cannot be built is an error; one that is
# AUTO is left out with a word, and comes in when its tool does.
set -eu
cmake=$1 sources=$2 compiler=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
log=$work/log

# again OPTION...: configures what is there, without any other part, and a static library.
again() {
    "$cmake" -S "$sources" -B "$work/build" -DCMAKE_C_COMPILER="$compiler" -DBUILD_SHARED_LIBS=OFF \
        -DSPHG_OPENMP=OFF -DSPHG_COMPILER_HAS_V3=OFF \
        -DSPHG_COMPILER_HAS_V4=OFF -DSPHG_BUILD_TESTS=OFF -DSPHG_BUILD_BENCH=OFF -DSPHG_BUILD_EXAMPLES=OFF \
        "$@" >"$log" 2>&1
}
# configured OPTION...: the same from the beginning, without a Fortran compiler.
configured() {
    rm -rf "$work/build"
    again -DCMAKE_Fortran_COMPILER=NOTFOUND "$@"
}
says() {
    tr '\n' ' ' <"$log" | tr -s ' ' | grep -qF "$1" || { cat "$log" >&2; echo "not said: $1" >&2; exit 1; }
}
leaves_nothing_out() {
    ! grep 'left out' "$log" >&2 || exit 1
}

configured -DSPHG_BUILD_PYTHON=AUTO -DSPHG_BUILD_FORTRAN=AUTO || { cat "$log" >&2; exit 1; }
says 'sphgrad: the Python package is left out: Python loads the shared library'
says 'sphgrad: the Fortran module is left out: there is no Fortran compiler'
! configured -DSPHG_BUILD_PYTHON=ON -DSPHG_BUILD_FORTRAN=OFF
says 'sphgrad: SPHG_BUILD_PYTHON is ON, but Python loads'
! configured -DSPHG_BUILD_PYTHON=OFF -DSPHG_BUILD_FORTRAN=ON
says 'sphgrad: SPHG_BUILD_FORTRAN is ON, but there is no'
configured -DSPHG_BUILD_PYTHON=OFF -DSPHG_BUILD_FORTRAN=OFF
leaves_nothing_out

# A Fortran compiler that is installed between two configurations.
if command -v f95 >/dev/null; then
    rm -rf "$work/build"
    FC=$work/none again -DSPHG_BUILD_PYTHON=OFF
    says 'sphgrad: the Fortran module is left out: there is no Fortran compiler'
    again
    says 'The Fortran compiler identification is'
    leaves_nothing_out
fi
