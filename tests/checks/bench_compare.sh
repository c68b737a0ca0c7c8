#!/bin/sh
# SPDX-License-Identifier: MIT
# bench_compare.sh PYTHON ROOT PROGRAM: bench/compare finds a report like itself, and sees what takes longer.
set -eu
python=$1 root=$2 program=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
compare() { "$python" -B "$root/bench/compare" "$@"; }

"$program" solver --matrices 100 --repetitions 2 --threads 1 --json "$work/old.json" >/dev/null
compare "$work/old.json" "$work/old.json" >"$work/same"
grep -q '^solver/.* 1\.000$' "$work/same"
! grep -q '^solver/.*\*$' "$work/same"
"$python" - "$work" <<'END'
import json, sys
folder = sys.argv[1]
with open(folder + "/old.json") as file:
    report = json.load(file)
for entry in report["benchmarks"]:
    entry["real_time"] *= 2000 if "SVD" in entry["run_name"] else 1
with open(folder + "/new.json", "w") as file:
    json.dump(report, file)
END
compare "$work/old.json" "$work/new.json" >"$work/twice"
grep -q '^solver/.*/SVD/.* 2000\.000 \*$' "$work/twice"
[ "$(grep -c ' 1\.000$' "$work/twice")" -gt 10 ]
compare "$work/old.json" "$work/new.json" SVD f32 >"$work/some"
! grep -q eigen "$work/some"
compare --help >"$work/help"
grep -q '^  bench/compare OLD.json NEW.json ' "$work/help"
# What is kept says the same in fewer bytes; and what stands in bench/results is that.
compare --keep "$work/old.json" >"$work/kept.json"
compare "$work/old.json" "$work/kept.json" | grep -q '^solver/.* 1\.000$'
[ "$(wc -c <"$work/kept.json")" -lt "$(($(wc -c <"$work/old.json") / 4))" ]
! grep -q host_name "$work/kept.json"
for kept in "$root"/bench/results/*/*.json; do
    compare --keep "$kept" | cmp - "$kept"
    compare "$kept" "$kept" | grep -q ' 1\.000$'
done
code=0
compare "$work/old.json" /nonexistent.json 2>"$work/errors" || code=$?
[ "$code" -eq 2 ] && grep -q nonexistent "$work/errors"
