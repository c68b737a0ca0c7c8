#!/bin/sh
# SPDX-License-Identifier: MIT
# layers.sh ROOT: the folders of src are layers, and each file may include its own folder and those below it.
# The public header is what all of them serve: everyone may include it, it includes the standard.
cd "$1" || exit 1

# From the lowest; src/README.md shows them. Every folder may include those named before it.
order="internal.h passes core search plan sweep api"

status=0
complain() {
    echo "$*" >&2
    status=1
}

files=$(cd src && find . -name '*.[ch]' | sed 's|^\./||' | sort)
[ -n "$files" ] || complain "src holds no sources"

# What a file includes in quotes stands beside it, or is named from src.
# shellcheck disable=SC2086 # the files are words
(cd src && awk -v order="$order" -v files="$(echo $files)" '
    function complain(text) { print text; failed = 1 }
    function layer_of(path) { sub(/\/.*/, "", path); return path }
    BEGIN {
        for (k = split(order, names, " "); k > 0; k--) height[names[k]] = k
        for (k = split(files, names, " "); k > 0; k--) {
            is_there[names[k]] = 1
            if (!(layer_of(names[k]) in height)) complain("src/" names[k] " stands in no layer")
        }
    }
    /^[ \t]*#[ \t]*include[ \t]*"/ {
        split($0, parts, "\"")
        beside = FILENAME
        if (!sub(/\/[^\/]*$/, "/", beside)) beside = ""
        name = (beside parts[2]) in is_there ? beside parts[2] : parts[2]
        if (!(name in is_there) || !(layer_of(name) in height))
            complain("src/" FILENAME " includes \"" name "\", which is no file of a layer")
        else if (height[layer_of(name)] > height[layer_of(FILENAME)])
            complain("src/" FILENAME " includes " name ", which stands above it")
    }
    END { exit failed }' $files) >&2 || status=1
# A header and its source are one part: none needs itself by way of others.
# shellcheck disable=SC2086
(cd src && awk '
    function part(path) { sub(/\.[ch]$/, "", path); return path }
    /^[ \t]*#[ \t]*include[ \t]*"/ {
        split($0, parts, "\"")
        beside = FILENAME
        sub(/[^\/]*$/, "", beside)
        name = parts[2] ~ /\// ? parts[2] : beside parts[2]
        if (part(name) != part(FILENAME)) print part(FILENAME), part(name)
    }' $files) | tsort >/dev/null || complain "files of src include one another in a circle"
for folder in $order; do
    [ -e "src/$folder" ] || complain "src/$folder is named as a layer and is not there"
    grep -q "$folder" src/README.md || complain "src/README.md does not show $folder"
done

if grep -rn --include='*.[ch]' -E 'include *<omp\.h>|pragma omp' src | grep -v '^src/core/parallel\.c:' >&2; then
    complain "OpenMP is parallel.c's alone"
fi
if grep -n --include='*.[ch]' -rE '"[^"]*%[-+ #0-9.*]*l?[aefgAEFG]' src | grep -v '^src/core/digits\.c:' >&2; then
    complain "numbers are printed by digits.c alone"
fi
if grep -n '#include "' include/sphgrad/*.h | grep -vE '"(sphgrad|small_matrices)\.h"' >&2; then
    complain "a public header includes a file of ours"
fi
exit $status
