#!/bin/sh
# SPDX-License-Identifier: MIT
# covered.sh HEADER LAYOUT HPP...: the C++ headers call every function of the C header, and set or leave to the
# host every member of its structs.
set -eu
header=$1 layout=$2
shift 2
status=0
count=0
for name in $(awk '$1 == "function" { print $2 }' "$layout"); do
    count=$((count + 1))
    grep -qE "\b$name\b" "$@" || { echo "the C++ headers do not call $name" >&2; status=1; }
done
[ "$count" -gt 20 ]
grep -q "sphg_evaluate(" "$header"
# Structs that the host fills, or reads, as they are in C.
as_in_c="sphg_config sphg_context_info sphg_scheme sphg_geometry sphg_lists sphg_neighbors_info sphg_list_fault
    sphg_stats sphg_subset sphg_view"
for structure in $(awk '$1 == "struct" { print $2 }' "$layout"); do
    grep -qE "\b$structure\b" "$@" || { echo "the C++ headers do not know $structure" >&2; status=1; }
    case " $(echo $as_in_c) " in *" $structure "*) continue ;; esac
    for member in $(awk -v s="$structure" '$1 == "member" && $2 == s { print $3 }' "$layout"); do
        grep -qE "(made|pairs)\.$member\b" "$@" ||
            { echo "the C++ headers do not set $structure.$member" >&2; status=1; }
    done
done
exit $status
