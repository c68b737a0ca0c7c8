#!/bin/sh
# SPDX-License-Identifier: MIT
# licences.sh ROOT: every source and script names its licence in its first lines, as SPDX has it.
cd "$1" || exit 1
status=0
files=$(find . \( -name build -o -name out -o -name .git -o -path ./shared/review \) -prune -o -type f \
    \( -name '*.[ch]' -o -name '*.cpp' -o -name '*.hpp' -o -name '*.f90' -o -name '*.py' -o -name '*.sh' -o -name '*.gp' \
    -o -name '*.cmake' -o -name CMakeLists.txt -o -name '*.yml' -o -path '*/run' -o -path './tools/*' -o -path './bench/compare' \) -print)
[ "$(echo "$files" | wc -l)" -gt 400 ] || { echo "only $(echo "$files" | wc -l) sources are seen" >&2; exit 1; }
for file in $files; do
    sed 5q "$file" | grep -q 'SPDX-License-Identifier: MIT' || { echo "$file names no licence: SPDX-License-Identifier: MIT" >&2; status=1; }
done
exit $status
