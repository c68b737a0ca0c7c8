#!/bin/sh
# SPDX-License-Identifier: MIT
# gates_fail.sh PROGRAM BROKEN_LIBRARY WAY...: the gates of a scene hold with the library as it is, seen
# through the wrapper that can break it, and one on a corrected method fails for each WAY to break it.
program=$1 wrapper=$2
shift 2
status=0

complain() {
    echo "$*" >&2
    status=1
}

# judged WAY: the lines of gates, and the exit status in the last one.
judged() {
    BROKEN_LIBRARY=$1 LD_PRELOAD=$wrapper "$program" --check --brief --method kgc 2>&1
    echo "status $?"
}

fails='^gate .* kgc .* FAILED$'
found=$(judged none)
printf '%s\n' "$found" | grep -q '^gate .* kgc .* ok$' || complain "no gate on the corrected method: $found"
printf '%s\n' "$found" | grep -qx 'status 0' || complain "a gate fails with the library as it is: $found"
for way; do
    found=$(judged "$way")
    printf '%s\n' "$found" | grep -q "$fails" || complain "all gates hold with the library broken by '$way': $found"
    printf '%s\n' "$found" | grep -qx 'status 1' || complain "'$way' does not end with status 1: $found"
done
exit $status
