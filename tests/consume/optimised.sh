#!/bin/sh
# SPDX-License-Identifier: MIT
# optimised.sh CMAKE PROJECT BUILD OPTION...: configures a project whose subdirectory the library is, and asks what
# would be compiled: each file of the library with optimisation, although its host asks for none, and in IEEE
# arithmetic, although its host does without.
set -eu
cmake=$1 project=$2 build=$3
shift 3
rm -rf "$build"
"$cmake" -S "$project" -B "$build" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "$@" >"$build.log" 2>&1 || {
    cat "$build.log" >&2
    exit 1
}
commands=$build/compile_commands.json
files=$(grep -c '"command":.*[/]src/[a-z0-9_/]*\.c"*,*$' "$commands" || true)
held=$(grep '"command":.*[/]src/[a-z0-9_/]*\.c"*,*$' "$commands" | grep -e ' -O[23] ' |
    grep -ce '-ffast-math .*-fno-fast-math ' || true)
echo "$held of $files files"
[ "$files" -gt 30 ] && [ "$held" -eq "$files" ]
