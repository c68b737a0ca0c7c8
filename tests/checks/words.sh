#!/bin/sh
# SPDX-License-Identifier: MIT
# words.sh ROOT: words that had two meanings in src, or another name than docs/design.md has, do not come back.
cd "$1" || exit 1
status=0
while read -r dead word; do
    if grep -rnwE --include='*.[ch]' "$dead" src >&2; then
        echo "src says $dead, where the word is: $word" >&2
        status=1
    fi
    grep -q "^| .*$word" docs/design.md || { echo "docs/design.md does not say what $word is" >&2; status=1; }
done <<'END'
lattices? raster
(sphgi_)?surroundings(_of)? halo
arenas? sums
guarded masked
forward one-sided
END
exit $status
