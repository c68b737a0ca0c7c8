#!/bin/sh
# SPDX-License-Identifier: MIT
# optimised.sh COMPILE_COMMANDS: each file of the library is compiled with optimisation, although its
# host asked for none, and in IEEE arithmetic, although its host did without.
set -eu
files=$(grep -c '"command":.*[/]src/[a-z0-9_/]*\.c"*,*$' "$1" || true)
held=$(grep '"command":.*[/]src/[a-z0-9_/]*\.c"*,*$' "$1" | grep -e ' -O[23] ' | grep -ce '-ffast-math .*-fno-fast-math ' || true)
echo "$held of $files files"
[ "$files" -gt 30 ] && [ "$held" -eq "$files" ]
