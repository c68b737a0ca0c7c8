#!/bin/sh
# SPDX-License-Identifier: MIT
# example_fails.sh PROGRAM BROKEN_LIBRARY WAY...: an example of the staircase prints a number and ends with status 0 with the
# library as it is, seen through the wrapper that can break it, and with another when the library is broken
# in each of these ways (broken_library.c).
program=$1 wrapper=$2
shift 2
status=0

found=$(BROKEN_LIBRARY=none LD_PRELOAD=$wrapper "$program" 2>&1) || {
    echo "fails with the library as it is: $found" >&2
    status=1
}
printf '%s\n' "$found" | grep -q '[0-9]' || { echo "prints no number: $found" >&2; status=1; }
for how in "$@"; do
    if found=$(BROKEN_LIBRARY=$how LD_PRELOAD=$wrapper "$program" 2>&1); then
        echo "does not notice a library that is broken ($how): $found" >&2
        status=1
    fi
done
exit $status
