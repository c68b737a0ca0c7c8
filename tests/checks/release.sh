#!/bin/sh
# SPDX-License-Identifier: MIT
# release.sh ROOT: files that name the version have that of the header, and recipes know options that are there.
cd "$1" || exit 1
status=0
complain() { echo "$*" >&2; status=1; }
version=$(sed -n 's/^#define SPHG_VERSION_[MP][A-Z]* \([0-9]*\).*/\1/p' include/sphgrad/sphgrad.h | paste -sd. -)
for file in CITATION.cff packaging/vcpkg/vcpkg.json packaging/conan/conanfile.py; do
    named=$(sed -n 's/^ *"\{0,1\}version"\{0,1\}[ =:]*"\{0,1\}\([0-9][0-9.]*\).*/\1/p' "$file")
    [ "$named" = "$version" ] || complain "$file has the version $named, the header $version"
done
grep -q "^## $version" CHANGELOG.md || complain "CHANGELOG.md has no entry for $version"
options=$(sed -n 's/^ *option(\([A-Z_]*\).*/\1/p; s/^ *set(\(SPHG_[A-Z_]*\) [A-Z$].* CACHE.*/\1/p; s/^ *sphg_binding(\([A-Z_]*\).*/\1/p' \
    CMakeLists.txt src/bindings/CMakeLists.txt | sort -u)
named=$(grep -rhoE 'SPHG_[A-Z_]+[A-Z]|"SPHG_BUILD_" \+ part|\("TESTS".*\)' packaging | sed 's/^"SPHG_BUILD_" + part$//' | grep -oE '[A-Z_]{4,}' |
    sed 's/^\(TESTS\|BENCH\|EXAMPLES\|PYTHON\|FORTRAN\)$/SPHG_BUILD_\1/' | sort -u | grep '^SPHG_' | grep -vx SPHG_BUILD)
[ "$(echo "$named" | wc -l)" -ge 6 ] || complain "the recipes name no options"
for option in $named; do
    echo "$options" | grep -qx "$option" || complain "packaging names $option, which is no option"
done
exit $status
