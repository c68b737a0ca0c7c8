#!/bin/sh
# SPDX-License-Identifier: MIT
# page.sh PAGE LANGUAGE PROGRAM: the first block of that language on the page is the program, but for its licence.
set -eu
work=$(mktemp)
trap 'rm -f "$work"' EXIT
awk -v fence="\`\`\`$2" '$0 == fence && !shown { inside = shown = 1; next } /^```/ { inside = 0 } inside' "$1" >"$work"
[ -s "$work" ]
grep -v SPDX-License-Identifier: "$3" | diff - "$work"
