#!/bin/sh
# SPDX-License-Identifier: MIT
# fetch_content.sh CMAKE ROOT FOLDER COMPILER: the block of the README that fetches the sources makes a project, whose
# program would be linked with the library. Configured only: other projects build.
set -eu
cmake=$1 root=$2 folder=$3 compiler=$4
rm -rf "$folder"
mkdir -p "$folder/project"
awk '/^```cmake$/ { inside = 1; block = ""; next }
    inside && /^```$/ { inside = 0; if (block ~ /FetchContent/) printf "%s", block; next }
    inside { block = block $0 "\n" }' "$root/README.md" >"$folder/block"
[ -s "$folder/block" ]
{
    echo 'cmake_minimum_required(VERSION 3.22)'
    echo 'project(app LANGUAGES C)'
    echo "add_executable(app $root/examples/gradient.c)"
    cat "$folder/block"
} >"$folder/project/CMakeLists.txt"
"$cmake" -S "$folder/project" -B "$folder/build" -DCMAKE_C_COMPILER="$compiler" \
    -DFETCHCONTENT_SOURCE_DIR_SPHGRAD="$root" -DSPHGRAD_REPOSITORY="$root" >"$folder/log" 2>&1 || {
    cat "$folder/log"
    exit 1
}
grep -rq libsphgrad "$folder/build" || { echo 'the program is not linked with the library'; exit 1; }
