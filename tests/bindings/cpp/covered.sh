#!/bin/sh
# SPDX-License-Identifier: MIT
# covered.sh HEADER HPP LAYOUT: the C++ header calls every function of the C header, and sets or leaves to the
# host every member of its structs.
set -eu
header=$1 hpp=$2 layout=$3
status=0
count=0
for name in $(awk '$1 == "function" { print $2 }' "$layout"); do
    count=$((count + 1))
    grep -qE "\b$name\b" "$hpp" || { echo "sphgrad.hpp does not call $name" >&2; status=1; }
done
[ "$count" -gt 20 ]
grep -q "sphg_evaluate(" "$header"
# Structs that the host fills, or reads, as they are in C.
as_in_c="sphg_config sphg_context_info sphg_scheme sphg_geometry sphg_lists sphg_neighbors_info sphg_list_fault
    sphg_stats sphg_subset sphg_view"
for structure in $(awk '$1 == "struct" { print $2 }' "$layout"); do
    grep -qE "\b$structure\b" "$hpp" || { echo "sphgrad.hpp does not know $structure" >&2; status=1; }
    case " $(echo $as_in_c) " in *" $structure "*) continue ;; esac
    for member in $(awk -v s="$structure" '$1 == "member" && $2 == s { print $3 }' "$layout"); do
        grep -qE "(made|pairs)\.$member\b" "$hpp" ||
            { echo "sphgrad.hpp does not set $structure.$member" >&2; status=1; }
    done
done
exit $status
