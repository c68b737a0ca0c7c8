#!/bin/sh
# SPDX-License-Identifier: MIT
# pkg_config.sh shared|static LIBDIR PROGRAM SOURCE COMPILER: builds and runs a program with the flags
# that pkg-config gives.
set -eu
kind=$1 libdir=$2 program=$3 source=$4 compiler=$5
PKG_CONFIG_PATH=$libdir/pkgconfig
export PKG_CONFIG_PATH
static=
[ "$kind" = shared ] || static=--static
# shellcheck disable=SC2046,SC2086 # the flags are words
"$compiler" "$source" -o "$program" $(pkg-config $static --cflags --libs sphgrad)
LD_LIBRARY_PATH=$libdir "$program"
