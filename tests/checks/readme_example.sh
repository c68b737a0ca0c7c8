#!/bin/sh
# readme_example.sh ROOT: the first C block of the README is examples/gradient.c to the letter.
set -eu
cd "$1"
awk '/^```c$/ { inside = 1; next } inside && /^```$/ { exit } inside' README.md |
    diff - examples/gradient.c
