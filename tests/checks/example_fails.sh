#!/bin/sh
# example_fails.sh PROGRAM BROKEN_LIBRARY: an example of the staircase prints a number and ends with status 0 with the
# library as it is, seen through the wrapper that can break it, and with another when all results are zeros.
program=$1 wrapper=$2
status=0

found=$(BROKEN_LIBRARY=none LD_PRELOAD=$wrapper "$program" 2>&1) || {
    echo "fails with the library as it is: $found" >&2
    status=1
}
printf '%s\n' "$found" | grep -q '[0-9]' || { echo "prints no number: $found" >&2; status=1; }
if found=$(BROKEN_LIBRARY=zero LD_PRELOAD=$wrapper "$program" 2>&1); then
    echo "does not notice a library that finds nothing: $found" >&2
    status=1
fi
exit $status
