#!/bin/sh
# SPDX-License-Identifier: MIT
# named_files.sh ROOT: what the tables of docs/theory.md (equations to functions) and docs/design.md (layers)
# name is there, and design.md names every source of the library.
cd "$1" || exit 1
status=0

complain() {
    echo "$*" >&2
    status=1
}

# quoted: the words in backticks of what is read, one a line.
quoted() { grep -o '`[^`]*`' | tr -d '`'; }

# column N FILE TITLE: that column of the rows of the table of FILE whose head begins with TITLE.
column() {
    awk -F'|' -v n="$1" -v title="$3" '
        index($0, "| " title " |") == 1 { inside = 1; next }
        inside && !/^\|/ { inside = 0 }
        inside && !/^\|-/ { print $(n + 1) }' "$2"
}

# find_source NAME: where the library has a file or folder of that name, with or without the folder it stands in.
sources=$(find src | sort)
find_source() {
    for source in $sources; do
        case $source in "src/$1" | src/*/"$1") return 0 ;; esac
    done
    source=
    return 1
}

# Of the interface: declared in the header, members after a dot.
interface=$(column 3 docs/theory.md equation | quoted | tr -d '()' | tr . ' ')
[ -n "$interface" ] || complain "docs/theory.md has no table of functions"
declared=" $(cat include/sphgrad/*.h | tr -cs 'A-Za-z0-9_' ' ') "
for name in $interface; do
    case $declared in
        *" $name "*) ;;
        *) complain "docs/theory.md: $name, not in the header" ;;
    esac
done

# In the code: a file, then functions that stand in it.
file=
for name in $(column 4 docs/theory.md equation | quoted); do
    case $name in
        *.[ch])
            find_source "$name" || complain "docs/theory.md: there is no $name"
            file=$source
            ;;
        *) grep -qw "$name" "$file" 2>/dev/null || complain "docs/theory.md: no $name in $file" ;;
    esac
done

# A name of a layer is a file, a directory, or all files of that name.
layers=$(column 2 docs/design.md layer | quoted)
[ -n "$layers" ] || complain "docs/design.md has no table of layers"
for name in $layers; do
    [ -e "$name" ] || find_source "${name%/}" || find_source "$name.c" || find_source "$name.h" ||
        complain "docs/design.md, layers: there is no $name"
done
# Elsewhere: file names in backticks.
for name in $(quoted <docs/design.md | grep '^[a-z_0-9/.]*\.\(c\|h\|inl\.h\|sh\)$'); do
    [ -e "$name" ] || find_source "$name" || complain "docs/design.md: there is no $name"
done

all=" $(quoted <docs/design.md | tr '\n' ' ') "
for path in src/*.[ch] src/*/*.[ch]; do
    file=${path##*/}
    case $path in src/passes/*) continue ;; esac
    stem=${file%.*}
    case $all in
        *" $file "* | *" $stem "*) ;;
        *) complain "docs/design.md does not name $path" ;;
    esac
done
exit $status
