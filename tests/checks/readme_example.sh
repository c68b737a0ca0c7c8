#!/bin/sh
# SPDX-License-Identifier: MIT
# readme_example.sh ROOT: the first C block of the README is examples/gradient.c to the letter, but for its licence.
set -eu
cd "$1"
work=$(mktemp)
trap 'rm -f "$work"' EXIT
grep -v SPDX-License-Identifier: examples/gradient.c >"$work"
awk '/^```c$/ { inside = 1; next } inside && /^```$/ { exit } inside' README.md |
    diff - "$work"
