#!/bin/sh
# SPDX-License-Identifier: MIT
# style.sh ROOT: what clang-format does not see to is the same in every file of C: how counters are increased,
# includes, guards of headers, tags of structs, blank lines, the length of lines and of functions.
cd "$1" || exit 1
status=0
sources=$(find src include bench shared tests examples -name '*.[ch]' | LC_ALL=C sort)
[ -n "$sources" ] || exit 1

# shellcheck disable=SC2086 # the files are words
awk '
    function complain(text) { printf "%s:%d: %s\n", FILENAME, FNR, text; failed = 1 }
    # The name of a header begins its guard, and so does where it stands.
    function guard_of(path,   name) {
        name = path
        sub(/.*\//, "", name)
        gsub(/[^A-Za-z0-9]/, "_", name)
        return toupper(name)
    }
    FNR == 1 { blank = 0; in_function = 0; guard = ""; formatted = 1 }
    /clang-format off/ { formatted = 0 }
    /clang-format on/ { formatted = 1 }

    length($0) > 100 && formatted && FILENAME !~ /^include\// { complain("more than 100 characters") }
    /\t/ { complain("a tab") }
    /[ \t]$/ { complain("blanks at the end") }
    blank && /^$/ { complain("two blank lines") }
    { blank = /^$/ }

    # Where the value of an increment is not used, it stands in front.
    /(; |^[ \t]*)[a-z_][a-z_0-9>.\[\]-]*(\+\+|--)[;),]/ { complain("k++, where everyone has ++k") }

    # Includes of ours, then those of others, without a blank line between.
    /^#include </ && after_blank { complain("a blank line among the includes") }
    { after_blank = ours_before && /^$/; ours_before = /^#include "/ }

    # A guard is the name of the header in capitals, behind that of its place.
    /^#ifndef [A-Z_0-9]+_H$/ && guard == "" && FILENAME ~ /\.h$/ {
        guard = $2
        if (substr(guard, length(guard) - length(guard_of(FILENAME)) + 1) != guard_of(FILENAME))
            complain(guard " does not end with " guard_of(FILENAME))
        if (guard in place) complain(guard " guards " place[guard] ", too")
        place[guard] = FILENAME
    }
    /^#define [A-Z_0-9]+_H$/ && FILENAME ~ /\.h$/ && $2 != guard { complain("defines " $2 " under " guard) }

    # Types by typedef carry the name of their struct.
    /^typedef (struct|union|enum) *\{/ { complain("a typedef without a tag") }

    /^\{$/ { in_function = FNR }
    /^\}$/ && in_function { if (FNR - in_function > 80) complain("a function of more than 80 lines"); in_function = 0 }
    END { exit failed }' $sources >&2 || status=1

# Scripts and documents: lines that a side-by-side view still shows.
find bench tests examples docs cmake src -name '*.sh' -o -name '*.py' -o -name '*.gp' -o -name 'CMakeLists.txt' |
    LC_ALL=C sort | xargs awk '
    /[ \t]$/ { printf "%s:%d: blanks at the end\n", FILENAME, FNR; failed = 1 }
    length($0) > 180 && FILENAME !~ /\.gp$/ { printf "%s:%d: more than 180 characters\n", FILENAME, FNR; failed = 1 }
    END { exit failed }' >&2 || status=1
exit $status
