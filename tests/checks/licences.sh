#!/bin/sh
# SPDX-License-Identifier: MIT
# licences.sh ROOT: every source and script names its licence, as SPDX has it.
cd "$1" || exit 1
files=$(find . \( -name build -o -name out -o -name .git -o -path ./shared/review \) -prune -o -type f \
    \( -name '*.[ch]' -o -name '*.cpp' -o -name '*.hpp' -o -name '*.f90' -o -name '*.py' -o -name '*.sh' -o -name '*.gp' \
    -o -name '*.cmake' -o -name CMakeLists.txt -o -name '*.yml' -o -path '*/run' -o -path './tools/*' -o -path './bench/compare' \) -print)
[ "$(echo "$files" | wc -l)" -gt 400 ] || { echo "only $(echo "$files" | wc -l) sources are seen" >&2; exit 1; }
# shellcheck disable=SC2086 # the files are words
unnamed=$(grep -L 'SPDX-License-Identifier: MIT' $files)
[ -z "$unnamed" ] || { echo "these name no licence (SPDX-License-Identifier: MIT):" $unnamed >&2; exit 1; }
