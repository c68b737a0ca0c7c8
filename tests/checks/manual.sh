#!/bin/sh
# SPDX-License-Identifier: MIT
# manual.sh ROOT FOLDER: docs/run makes the manual without a warning; each function of the header has a text in it,
# each example a page, no link leads nowhere, and nothing is fetched from a network.
set -eu
root=$1 folder=$2
status=0
complain() { echo "$*" >&2; status=1; }

rm -rf "$folder"
"$root/docs/run" "$folder" >/dev/null
cd "$folder"
[ -d search ] || complain 'there is no search'
for name in $(sed -n 's/^SPHG_API [a-z_0-9 ]*[ *]\(sphg_[a-z_]*\)(.*/\1/p' "$root"/include/sphgrad/*.h); do
    cat group__*.html | grep -qE "(>|\b)$name(<|</b>)" || complain "$name is not in the manual"
done
for example in "$root"/examples/*.c; do
    name=$(basename "$example" .c)_8c-example.html
    [ -f "$name" ] || complain "$(basename "$example") has no page"
done
grep -ohE '(src|href)="[^"#]+' ./*.html | sed 's/^[^"]*"//' | sort -u | while read -r target; do
    case $target in
        https://doi.org/* | https://www.doxygen.org/* | http:* | https:* | mailto:* | javascript:*) continue ;;
    esac
    [ -e "$target" ] || echo "$target"
done >missing_links
[ ! -s missing_links ] || complain "links lead nowhere: $(cat missing_links)"
! grep -lE '<(script|link|img)[^>]*(src|href)="https?:' ./*.html >&2 || complain 'these pages fetch from a network'
exit $status
