#!/bin/sh
# SPDX-License-Identifier: MIT
# layout.sh HEADER NAMES: a C program that prints what a binding must agree with: sizes of the structs,
# offsets and sizes of their members, values of the enumerators, and the functions with their parameters.
set -eu
header=$1 names=$2
cat <<'PROGRAM'
/* Written by tests/bindings/layout.sh. */
#include <sphgrad/sphgrad.h>
#include <stdio.h>
#define STRUCT(s)    printf("struct " #s " %zu\n", sizeof(struct s));
#define MEMBER(s, m) printf("member " #s " " #m " %zu %zu\n", offsetof(struct s, m), sizeof(((struct s *)0)->m));
#define ENUM(e, n)   printf("enum " #e " " #n " %d\n", (int)n);
#define FUNCTION(f)  puts("function " f);
int main(void)
{
    printf("version %d\n", SPHG_VERSION);
PROGRAM
sed -n '/define PUBLIC_MEMBERS/,$s/.*X(\(sphg_[a-z_]*\), "\([a-z_0-9]*\)").*/\1 \2/p' "$names" |
    while read -r structure member; do
        echo "    STRUCT($structure)"
        echo "    MEMBER($structure, $member)"
    done | awk '!seen[$0]++'
awk '
    /^#define SPHG_RESULT_LIST/ { results = 1; next }
    results && match($0, /X\([A-Z_]+,/) { print "sphg_result SPHG_" substr($0, RSTART + 2, RLENGTH - 3); next }
    { results = 0 }
    /^typedef enum sphg_[a-z]+ \{/ { enumeration = $3 }
    enumeration != "" {
        line = $0
        sub(/\/\*.*/, "", line)
        while (match(line, /SPHG_[A-Z0-9_]+ *=/)) {
            name = substr(line, RSTART, RLENGTH)
            sub(/ *=/, "", name)
            print enumeration, name
            line = substr(line, RSTART + RLENGTH)
        }
    }
    /^\}/ { enumeration = "" }' "$header" |
    while read -r enumeration name; do
        echo "    ENUM($enumeration, $name)"
    done
sed -n '/define PUBLIC_FUNCTIONS/,/define PUBLIC_MEMBERS/s/.*X(\(sphg_[a-z_0-9]*\), "\([^"]*\)").*/\1 \2/p' "$names" |
    while read -r name parameters; do
        echo "    FUNCTION(\"$name $parameters\")"
    done
echo '    return 0;'
echo '}'
