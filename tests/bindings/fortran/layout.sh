#!/bin/sh
# SPDX-License-Identifier: MIT
# layout.sh LAYOUT MODULE: a Fortran program that compares sizes, places and values with those of C (LAYOUT). Before
# that: the module declares each function, with the parameters of C in their order.
set -eu
layout=$1 module=$2
status=0
joined=$(mktemp)
trap 'rm -f "$joined"' EXIT
# Statements on one line.
awk '{ sub(/^ +/, ""); if (sub(/ *& *$/, "")) { printf "%s ", $0; next } print }' "$module" >"$joined"
awk '$1 == "function" { name = $2; $1 = $2 = ""; sub(/^ +/, ""); print name ":" $0 }' "$layout" |
    while IFS=: read -r name parameters; do
        wanted="$name($(echo $parameters | sed 's/ /, /g')) bind(c, name=\"$name\")"
        grep -E '^(function|subroutine) ' "$joined" | sed 's/^[a-z]* //; s/( /(/; s/  */ /g' | grep -qxF "$wanted" ||
            { echo "sphgrad.f90 does not declare $wanted" >&2; exit 1; }
    done || status=1
[ "$status" = 0 ]
awk '
    $1 == "version" { version = $2 }
    $1 == "struct" { structs[++count] = $2; size[$2] = $3 }
    $1 == "member" { members[++places] = $2 " " $3 " " $4 " " $5 }
    $1 == "enum" { values[++enumerators] = $3 " " $4 }
    END {
        print "! Written by tests/bindings/fortran/layout.sh."
        print "program layout\n  use, intrinsic :: iso_c_binding\n  use sphgrad\n  implicit none\n  integer :: wrong = 0"
        for (k = 1; k <= count; ++k)
            printf "  type(%s), target :: v_%s\n", structs[k], structs[k]
        printf "  call same(\"version\", int(SPHG_HEADER_VERSION), %d)\n", version
        for (k = 1; k <= count; ++k) {
            s = structs[k]
            printf "  call same(\"%s\", int(c_sizeof(v_%s)), %d)\n", s, s, size[s]
            printf "  call zero(\"%s\", transfer(v_%s, [0_c_int8_t]))\n", s, s
        }
        for (k = 1; k <= places; ++k) {
            split(members[k], m, " ")
            v = "v_" m[1] "%" m[2]
            printf "  call same(\"%s\", int(c_sizeof(%s)), %d)\n", v, v, m[4]
            printf "  call same(\"%s\", &\n    place(c_loc(v_%s), c_loc(%s)), %d)\n", v, m[1], v, m[3]
        }
        for (k = 1; k <= enumerators; ++k) {
            split(values[k], e, " ")
            printf "  call same(\"%s\", int(%s), %d)\n", e[1], e[1], e[2]
        }
        print "  if (wrong > 0) error stop 1"
        printf "  print *, \"%d members are where C has them\"\n", places
        print "contains"
        print "  integer function place(from, to)"
        print "    type(c_ptr), intent(in) :: from, to"
        print "    place = int(transfer(to, 0_c_intptr_t) - transfer(from, 0_c_intptr_t))"
        print "  end function place"
        print "  subroutine same(name, found, expected)"
        print "    character(*), intent(in) :: name"
        print "    integer, intent(in) :: found, expected"
        print "    if (found == expected) return"
        print "    print *, name, found, \" but in C \", expected"
        print "    wrong = wrong + 1"
        print "  end subroutine same"
        print "  subroutine zero(name, bytes)"
        print "    character(*), intent(in) :: name"
        print "    integer(c_int8_t), intent(in) :: bytes(:)"
        print "    if (all(bytes == 0)) return"
        print "    print *, name, \" does not begin as {0}\""
        print "    wrong = wrong + 1"
        print "  end subroutine zero"
        print "end program layout"
    }' "$layout"
