#!/bin/sh
# SPDX-License-Identifier: MIT
# bench_measures.sh PROGRAM CHECKER COMMAND: a small run of the command succeeds, says on which
# machine, prints no NaN, and its report is sound.
set -eu
program=$1 checker=$2 command=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

measure() {
    "$program" "$command" "$@" --json "$work/report.json" >"$work/output"
    grep -q '^machine ' "$work/output"
    if grep -iwE 'nan|-nan|inf|-inf' "$work/output" >&2; then
        exit 1
    fi
}

case $command in
    table1)
        measure --particles 4096 --repetitions 2 --output "$work/table1"
        [ "$(grep -c '^[A-Z]' "$work/table1/table1.csv")" -eq 6 ]
        grep -q '^method,.*paper_matrix,paper_gradient$' "$work/table1/table1.csv"
        ! grep -q 'table1.png' "$work/output" || [ -s "$work/table1/table1.png" ]
        "$checker" "$work/report.json" table1/KGC/gradient gradient_error 0 1e-5 table1/KGC/ kept_error 0 1e-5 \
            probe/ particles 4096 4096
        grep -q '^yardstick ' "$work/output"
        grep -q 'T_grad +weights .* [0-9]' "$work/output"
        ;;
    limit)
        measure --particles 4096 --repetitions 2
        "$checker" "$work/report.json" results/ deviation 0 1e-5 probe/ error_max 0 1e-5 \
            '/sums/baseline, 4 lanes/' percent_of_library 1e-9 1e9 limit/matrices/library+weights real_time 0 1e6
        grep -q '^+weights .*no kernel, root or division' "$work/output"
        grep -q '^  library, .* +weights  *[0-9]' "$work/output"
        measure --particles 1000 --repetitions 1 --support 2.5 --jitter 0 --threads 1
        "$checker" "$work/report.json" results/ deviation 0 1e-5
        measure --probe --particles 4096 --repetitions 2
        "$checker" "$work/report.json" probe/matrices error_max 0 1e-5 \
            probe/matrices matrix_deviation 0 1e-5
        ;;
    forces)
        # conservation to rounding; a library that returns zeros gives 0/0
        measure --particles 4096 --repetitions 1
        "$checker" "$work/report.json" forces/stress error 0 1e-5 forces/pressure error 0 1e-5 \
            'forces/divergence, adjoint' error 0 1e-5 forces/ real_time 0 1e6 \
            'forces/divergence, difference/KGC' error 0 1e-5 \
            'forces/divergence, difference/SPH' error 0.1 1
        measure --particles 1000 --repetitions 1 --precision f64
        "$checker" "$work/report.json" forces/stress error 0 1e-13
        ;;
    lists)
        measure --particles 4096 --repetitions 2 --threads 1
        "$checker" "$work/report.json" lists/ ns_per_pair 0.01 1e6 lists/sums/ error_max 0 1e-5 \
            "lists/sums/host's row function/fused" pairs 9e4 2e5 \
            'lists/pairs/indices and gradients' error_max 0 1e-5 'lists/pairs/the same' error_max 0 1e-5
        measure --particles 1000 --repetitions 1 --precision f64
        "$checker" "$work/report.json" lists/sums/ error_max 0 1e-13 \
            'lists/pairs/indices and gradients' error_max 0 1e-13
        ;;
    skip)
        measure --particles 4096 --repetitions 2
        "$checker" "$work/report.json" skip/ saved_percent -1e6 100 /full real_time 0 1e6 \
            skip/outputs targets_with_other_bits 0 0 skip/fields targets_with_other_bits 0 0 \
            skip/active targets_with_other_bits 0 0 skip/reuse deviation 0 1e-4 \
            'skip/reuse/neighbours' targets_with_other_bits 0 0 \
            'skip/reuse/list-free' targets_with_other_bits 0 0 \
            'skip/problem/one volume' targets_with_other_bits 0 0
        grep -q '"skin_was_spent":[[:space:]]*0' "$work/report.json"
        [ "$(grep -c 'same bits' "$work/output")" -ge 20 ]
        ;;
    frontier)
        measure --particles 512 --repetitions 1 --threads 1 --output "$work/frontier"
        "$checker" "$work/report.json" frontier/ trigonometric_mean 1e-3 1 \
            frontier/KGC/cubic/f32 linear_max 0 1e-5 \
            frontier/CMLS/cubic/f64 linear_max 0 1e-13 'frontier/KGC/cubic/f32/kept weights/table' linear_max 0 1e-5 \
            frontier/SPH linear_mean 0.1 1 frontier/ ns_per_particle 0.1 1e9
        # of cubes of 6, 8 and 16 particles an axis: order 2 inside, and lent at the surface, is nearer
        measure --order --particles 512 --repetitions 1 --threads 1 --output "$work/order"
        "$checker" "$work/report.json" 'order/order 1/2/16' boundary_max 0.2 0.8 \
            'order/order 1/2/16' inside_max 0.08 0.4 'order/order 2/2/16' inside_max 0.02 0.14 \
            'order/order 2/2.5/16' boundary_max 0.05 0.3 'order/order 2 lent/2/16' boundary_max 0.05 0.3
        [ "$(grep -c '^[oc]' "$work/order/frontier_order.csv")" -eq 36 ]
        ! grep -q 'frontier_order.png' "$work/output" || [ -s "$work/order/frontier_order.png" ]
        [ "$(grep -c '^[A-Z]' "$work/frontier/frontier.csv")" -eq 756 ]
        # weights are kept by methods that form them, and read by the second of two sweeps
        [ "$(grep -c ',kept weights,table,' "$work/frontier/frontier.csv")" -eq 63 ]
        [ "$(grep -c ',kept weights,' "$work/frontier/frontier.csv")" -eq 63 ]
        # each field has a frontier, with and without a search of the library's own
        for side in 'kept lists\|kept weights\|list-free' "host's lists"; do
            grep -q "$side.*,1,[01]$" "$work/frontier/frontier.csv"
            grep -q "$side.*,1$" "$work/frontier/frontier.csv"
        done
        ! grep -q 'frontier.png' "$work/output" || [ -s "$work/frontier/frontier.png" ]
        ;;
    scaling)
        measure --particles 1000 --repetitions 1 --threads 2 --full --output "$work/scaling"
        "$checker" "$work/report.json" scaling/ not_finite 0 0 scaling/ ns_per_particle 0.1 1e9 \
            scaling/particles/ error_max 1e-9 1e-5 scaling/cloud/jittered error_max 1e-9 1e-5 \
            'scaling/particles/30 000' deficient_share 0 0 \
            scaling/threads/1/ case_threads 1 1 scaling/threads/2/ case_threads 2 2 \
            'scaling/cloud/thin sheets' deficient_share 0.5 1 \
            'scaling/radii/' error_max 1e-9 1e-5 'scaling/radii/' pairs_per_particle 10 60 \
            'scaling/method/' error_max 1e-9 1e-3 \
            'scaling/weights/' error_max 1e-9 1e-5 'scaling/weights/kept' bytes_per_particle 150 600 \
            scaling/cloud/spray deficient_share 0.9 1 scaling/cloud/spray pairs_per_particle 1 3
        [ "$(grep -c '^[a-z]' "$work/scaling/scaling.csv")" -eq 33 ]
        ! grep -q 'scaling.png' "$work/output" || [ -s "$work/scaling/scaling.png" ]
        ;;
    solver)
        measure --matrices 100 --repetitions 1
        set --
        for what in 'invert moments/all certified' eigen/random eigen/near eigen/graded SVD/random SVD/near SVD/graded; do
            for size in 100 4096; do
                set -- "$@" "solver/3D/f32/$size/$what" deviation 0 1e-5 "solver/3D/f64/$size/$what" deviation 0 1e-13
            done
        done
        "$checker" "$work/report.json" solver/ ns_per_matrix 0.1 1e6 "$@" \
            'solver/3D/f32/100/invert moments/all fall back/baseline' decomposed_percent 100 100 \
            'solver/3D/f64/100/invert moments/all certified/baseline' decomposed_percent 0 0
        # both sizes in three dimensions and in two, all but the copies on each instruction set
        [ "$(grep -cE '^  [23]D, f(32|64), ' "$work/output")" -eq 8 ]
        ;;
    stability)
        measure --quick --threads 2 --output "$work/stability"
        "$checker" "$work/report.json" stability/ not_finite 0 0 stability/ wrong_ranks 0 0 \
            stability/ other_bits 0 0 stability/ compared 2 1e6 stability/ targets 32 1e9 \
            stability/ ratio_full 0 10 stability/ ratio_touched 0 16 \
            stability/slab/blend/KGC/f32/1e+12 rank 2 2 \
            stability/slab/blend/CRKPM/f64/1e+12 decomposed 1 1 \
            stability/threshold/replace/KGC/f32/0.3 noise 1 100 \
            stability/threshold/replace/KGC/f32/1e-06 noise 500 1e6 \
            stability/offset/blend/KGC/f32/1e+08 linear_mean 0.1 10 \
            stability/offset/blend/KGC/f64/1e+08 linear_mean 0 1e-6 \
            stability/offset/blend/RKPM/mixed/1e+08 linear_mean 0 1e-5 \
            stability/neighbours/blend/KGC/f32/300 rank 3 3 \
            stability/merging/blend/KGC/f64/1.1 correction_jump_left 0 0.5 \
            stability/merging/replace/KGC/f64/1.1 correction_jump_left 50 150
        # every place of every sweep for every method and precision, and a rank that only falls
        [ "$(grep -cE '^(slab|offset|neighbours|volumes|jitter),' "$work/stability/stability.csv")" -eq 360 ]
        [ "$(grep -cE '^(threshold|merging|scale),' "$work/stability/stability.csv")" -eq 474 ]
        awk -F, '$1 == "slab" && $3 != "SPH" { key = $3 $4; seen++
                     if (key == last && $10 > rank) exit failed = 1; last = key; rank = $10 }
                 END { exit failed || seen != 60 }' "$work/stability/stability.csv"
        ! grep -q 'pictures' "$work/output" || [ -s "$work/stability/stability_reading.png" ]
        # sweeps that run alone: radii, and order 2
        for sweep in grading curvature thinning; do
            measure --quick --sweep $sweep --threads 1 --output "$work/one"
            "$checker" "$work/report.json" "stability/$sweep/" not_finite 0 0 "stability/$sweep/" wrong_ranks 0 0 \
                "stability/$sweep/" compared 2 1e6 "stability/$sweep/" ratio_full 0 10
        done
        "$checker" "$work/report.json" stability/thinning/blend/KGC/f64/1e+12 rank 2 2 \
            stability/thinning/blend/KGC/f32/10000 rank 2 2 stability/thinning/ ratio_touched 0 4
        # a sweep alone, with other numbers
        measure --quick --sweep jitter --repetitions 2 --particles 64 --threads 1 --output "$work/one"
        [ "$(grep -c '^jitter,' "$work/one/stability.csv")" -eq 72 ]
        ;;
    *)
        echo "no check of $command" >&2
        exit 1
        ;;
esac
