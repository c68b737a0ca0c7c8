#!/bin/sh
# SPDX-License-Identifier: MIT
# pkg_config.sh shared|static LIBDIR PROGRAM SOURCE COMPILER [MODULE]: builds and runs a program with the flags
# that pkg-config gives. MODULE: a source that is compiled before it, in Fortran.
set -eu
kind=$1 libdir=$2 program=$3 source=$4 compiler=$5 module=${6-}
cd "$(dirname "$program")" # where a compiled module is left
PKG_CONFIG_PATH=$libdir/pkgconfig
export PKG_CONFIG_PATH
static=
[ "$kind" = shared ] || static=--static
# shellcheck disable=SC2046,SC2086 # the flags are words
"$compiler" ${module:+"$module"} "$source" -o "$program" $(pkg-config $static --cflags --libs sphgrad)
LD_LIBRARY_PATH=$libdir "$program"
