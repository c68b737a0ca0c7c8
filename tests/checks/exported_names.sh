#!/bin/sh
# SPDX-License-Identifier: MIT
# exported_names.sh NM HEADER LIBRARY: the shared library exports what the header declares with
# SPHG_API, no more and no less.
set -eu
nm=$1 header=$2 library=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sed -n 's/^SPHG_API [^(]*\(sphg_[a-z0-9_]*\)(.*/\1/p' "$header" | sort >"$work/declared"
# Sanitizers add names of their own, which begin with two underscores.
"$nm" -D --defined-only "$library" | awk '$3 !~ /^__/ { print $3 }' | sort >"$work/exported"
[ -s "$work/declared" ]
[ "$(grep -c '^SPHG_API ' "$header")" = "$(wc -l <"$work/declared" | tr -d ' ')" ]
diff "$work/declared" "$work/exported"
