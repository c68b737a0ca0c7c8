#!/bin/sh
# SPDX-License-Identifier: MIT
# plugin.sh shared|static LIBDIR FOLDER SOURCES COMPILER RESIDENT: builds a plugin with the flags
# that pkg-config gives, and a host that loads and unloads it.
# RESIDENT: what has started threads has to stay loaded.
set -eu
kind=$1 libdir=$2 folder=$3 sources=$4 compiler=$5 resident=$6
PKG_CONFIG_PATH=$libdir/pkgconfig
export PKG_CONFIG_PATH
static=
[ "$kind" = shared ] || static=--static
mkdir -p "$folder"
"$compiler" "$sources/host.c" -o "$folder/host" -pthread -ldl
# shellcheck disable=SC2046,SC2086 # the flags are words
"$compiler" -shared -fPIC "$sources/plugin.c" -o "$folder/plugin.so" \
    $(pkg-config $static --cflags --libs sphgrad)
holder=$folder/plugin.so
[ "$kind" = static ] || holder=$libdir/libsphgrad.so
set --
[ "$resident" = OFF ] || set -- resident "$holder"
[ "$kind" = shared ] || set -- "$@" hides sphg_context_create
LD_LIBRARY_PATH=$libdir "$folder/host" "$folder/plugin.so" 32 "$@"
