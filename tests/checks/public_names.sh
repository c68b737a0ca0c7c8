#!/bin/sh
# SPDX-License-Identifier: MIT
# public_names.sh HEADER: the functions that the header declares with their parameters, and the
# members of its structs, as X-macros. Tests expand them, so that what is new must have its rows.
set -eu
without_comments() {
    awk '
    {
        line = $0
        while (1) {
            if (inside) {
                end = index(line, "*/")
                if (!end) { line = ""; break }
                line = substr(line, end + 2)
                inside = 0
            }
            start = index(line, "/*")
            if (!start) break
            rest = substr(line, start + 2)
            line = substr(line, 1, start - 1)
            end = index(rest, "*/")
            if (!end) { inside = 1; break }
            line = line substr(rest, end + 2)
        }
        print line
    }' "$1"
}

without_comments "$1" | awk '
function last_word(text) {
    sub(/\[[^]]*\] *$/, "", text)
    if (match(text, /\(\*[a-z_]+\)/)) # a pointer to a function
        return substr(text, RSTART + 2, RLENGTH - 3)
    match(text, /[A-Za-z0-9_]+ *$/)
    text = substr(text, RSTART)
    gsub(/ /, "", text)
    return text
}
/^SPHG_API / { declaration = ""; reading = 1 }
reading {
    declaration = declaration " " $0
    if (declaration !~ /;/) next
    reading = 0
    match(declaration, /sphg_[a-z0-9_]+\(/)
    name = substr(declaration, RSTART, RLENGTH - 1)
    parameters = substr(declaration, RSTART + RLENGTH)
    sub(/\) *;.*/, "", parameters)
    words = ""
    count = split(parameters, each, ",")
    for (k = 1; k <= count; ++k)
        if (each[k] !~ /^ *void *$/)
            words = words " " last_word(each[k])
    functions = functions " \\\n    X(" name ", \"" words " \")"
}
/^typedef struct sphg_[a-z_]+ \{/ { structure = $3; body = ""; next }
structure != "" && /^\}/ {
    count = split(body, each, ";")
    for (k = 1; k < count; ++k) {
        line = each[k]
        if (line ~ /\(\*/) {
            members = members " \\\n    X(" structure ", \"" last_word(line) "\")"
            continue
        }
        parts = split(line, one, ",")
        for (p = 1; p <= parts; ++p)
            members = members " \\\n    X(" structure ", \"" last_word(one[p]) "\")"
    }
    structure = ""
}
structure != "" { body = body " " $0 }
END {
    print "/* Written by tests/checks/public_names.sh from the public header. */"
    print "#define PUBLIC_FUNCTIONS(X)" functions
    print "#define PUBLIC_MEMBERS(X)" members
}'
