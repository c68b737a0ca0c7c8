#!/bin/sh
# SPDX-License-Identifier: MIT
# abi.sh HEADER LAYOUT KEPT: what a program compiled against the header relies on is what src/package/abi.txt
# keeps: sizes, offsets, values of enumerators, and functions with their types, on machines with pointers of 64
# bits. Who changes the interface on purpose copies what is printed at the end; the difference is then part of
# the change. With a release a line of an old one may no longer change, and members are added behind the others.
set -eu
header=$1 layout=$2 kept=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
grep -v '^function ' "$layout" >"$work/abi.txt"
# Declarations without comments, one a line.
awk '
    /^SPHG_API / || /^typedef [a-z]+ sphg_task\(/ { inside = 1; text = "" }
    inside {
        gsub(/\/\*.*\*\//, "")
        gsub(/ +/, " ")
        sub(/^ /, "")
        text = text (text ? " " : "") $0
    }
    inside && /;/ {
        inside = 0
        sub(/^SPHG_API /, "", text)
        sub(/ *$/, "", text)
        print text
    }' "$header" >>"$work/abi.txt"
[ "$(grep -c ';$' "$work/abi.txt")" -eq $(($(grep -c '^function ' "$layout") + 1)) ] # sphg_task is no function
[ "$(grep -c '^member ' "$work/abi.txt")" -gt 100 ]
if ! diff "$kept" "$work/abi.txt"; then
    cp "$work/abi.txt" "$layout.abi"
    echo "the interface of compiled programs has changed; if that is meant: cp $layout.abi $kept" >&2
    exit 1
fi
