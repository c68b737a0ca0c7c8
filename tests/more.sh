# SPDX-License-Identifier: MIT
# What tests/run does beside the tests (sourced by it, from the root of the sources): one function
# for each option, run_<option>, with the words behind the option; and needs_of_<option>, the packages
# that it takes, where these are not those of the tests.

. tests/platforms/platforms.sh
. tests/packages/packages.sh

building=(build_essential cmake pkg_config cmocka lapacke cjson hdf5)
needs_of_coverage() { printf '%s\n' "${building[@]}" clang clang_openmp clang_runtime llvm python3; }
needs_of_analyse() { printf '%s\n' "${building[@]}" clang clang_tidy cppcheck; }
needs_of_valgrind() { printf '%s\n' "${building[@]}" valgrind; }
needs_of_mutants() { printf '%s\n' "${building[@]}" python3; }
needs_of_soak() { printf '%s\n' "${building[@]}"; }

# SPHG_NEON_AREAS, a regular expression, selects tests; all of them take half an hour.
run_neon() {
    . tools/foreign.sh
    require_foreign "$PWD/build/aarch64-packages" arm64 libcmocka-dev liblapacke-dev libcjson-dev &&
        build_preset neon -DSPHG_BUILD_TESTS=ON -DSPHG_WARNINGS_AS_ERRORS=$werror &&
        ctest --preset neon -j "$(nproc)" -R "${SPHG_NEON_AREAS:-.}"
}

# Archer tells ThreadSanitizer of OpenMP's synchronisation; the host's executor needs no such help.
run_tsan() {
    local archer
    build_preset tsan -DSPHG_BUILD_TESTS=ON || return 1
    archer=$(dirname "$(dirname "$(readlink -f "$(command -v clang)")")")/lib/libarcher.so
    OMP_TOOL_LIBRARIES=$archer TSAN_OPTIONS='ignore_noninstrumented_modules=1 halt_on_error=1' \
        ctest --preset tsan -R '^(threads|float_environment|host_process|memory_failures|sets)$'
}

# The areas that take SPHG_TEST_LONG=1; of the ensembles, whose reference is in quad, one process for
# each precision. Then what tests/run halves, whole, and what it leaves out: the bench under sanitizers, and with Clang
# the scenes, too; all scenes of the examples; and threads under ThreadSanitizer.
run_long() {
    local area precision preset process processes=() status=0
    build_preset release -DSPHG_BUILD_TESTS=ON || return 1
    export SPHG_TEST_LONG=1
    for area in extremes golden metamorphic; do
        "build/release/tests/test_$area" || status=1
    done
    for precision in f32 f64; do
        build/release/tests/test_solver_ensembles "*$precision*" >"build/release/$precision.log" 2>&1 &
        processes+=($!)
    done
    for process in "${processes[@]}"; do
        wait "$process" || status=1
    done
    cat build/release/f32.log build/release/f64.log
    unset SPHG_TEST_LONG
    ctest --preset release -C long -L '^long$' -j "$(nproc)" || status=1
    build_preset asan -DSPHG_BUILD_TESTS=ON -DSPHG_BUILD_BENCH=ON &&
        ctest --preset asan -j "$(nproc)" || status=1
    build_preset clang -DSPHG_COMPILER_HAS_V4=ON -DSPHG_BUILD_TESTS=ON -DSPHG_BUILD_BENCH=ON -DSPHG_BUILD_SCENES=ON &&
        ctest --preset clang -j "$(nproc)" || status=1
    examples/run all --check || status=1
    python3 tests/checks/scene_figures.py . build/examples/examples -- 1 5 || status=1
    run_tsan || status=1
    return $status
}

# New inputs go to build/fuzz/corpus, the kept ones are only read. SPHG_FUZZ_RUNS ends a target after
# so many executions, SPHG_FUZZ_TARGETS names some of them.
run_fuzz() {
    local targets=${SPHG_FUZZ_TARGETS:-search lists matrices calls kept}
    build_preset fuzz -DSPHG_BUILD_TESTS=ON || return 1
    printf '%s\n' $targets | xargs -P "$(nproc)" -I TARGET sh -c '
        log=build/fuzz/TARGET.log
        mkdir -p build/fuzz/corpus/TARGET
        if build/fuzz/tests/fuzz/fuzz_TARGET -max_total_time="${SPHG_FUZZ_SECONDS:-60}" \
            -runs="${SPHG_FUZZ_RUNS:--1}" -max_len=1024 -timeout=10 -rss_limit_mb=1024 \
            -entropic=0 -print_final_stats=1 -verbosity=0 -artifact_prefix=build/fuzz/TARGET- \
            build/fuzz/corpus/TARGET tests/fuzz/corpus/TARGET >"$log" 2>&1; then
            echo "TARGET: $(sed -n "s/^stat::number_of_executed_units: *//p" "$log") executions, nothing found"
        else
            cat "$log" >&2
            echo "TARGET: failed, the input is build/fuzz/TARGET-*" >&2
            exit 1
        fi'
}

# Valgrind knows no AVX-512 and no rounding mode but the default, and rounds long double to double: v3 is
# tried, float_environment and kernels are not. It takes thirty to sixty times as long; SPHG_VALGRIND_AREAS
# names other areas.
run_valgrind() {
    local areas=${SPHG_VALGRIND_AREAS:-errors request_errors metamorphic fig2_trigonometric memory_failures
        views small_matrices neighbors pairs crowds conservation classic exactness invariance}
    build_preset release -DSPHG_BUILD_TESTS=ON || return 1
    printf '%s\n' $areas | xargs -P "$(nproc)" -I AREA sh -c '
        log=build/release/AREA.valgrind
        if OMP_NUM_THREADS=2 valgrind -q --error-exitcode=1 build/release/tests/test_AREA >"$log" 2>&1; then
            echo "AREA: $(grep -c "^\[       OK" "$log") cases, nothing found"
        else
            grep -E "^==|FAILED" "$log" >&2
            echo "AREA: failed, see $log" >&2
            exit 1
        fi'
}

# run_soak [SECONDS]
run_soak() {
    build_preset release -DSPHG_BUILD_TESTS=ON -- --target test_soak || return 1
    SPHG_SOAK_SECONDS=${1:-1800} build/release/tests/test_soak
}

# run_mutants [COUNT [SEED]], or `again` for those that survived the last time.
run_mutants() {
    local which=(--count "${1:-200}" --seed "${2:-1}")
    [ "${1-}" != again ] || which=(--again)
    build_preset release -DSPHG_BUILD_TESTS=ON || return 1
    python3 -B tests/mutants/run.py build/release build/mutants "${which[@]}"
}

# As Clang sees the source, not the machine code: a condition counts twice, taken and not. What is
# compiled several times, the passes, counts as one: reached if any copy of it is.
run_coverage() {
    local profiles=build/coverage/profiles status=0
    build_preset coverage -DSPHG_BUILD_TESTS=ON || return 1
    rm -rf "$profiles"
    LLVM_PROFILE_FILE="$PWD/$profiles/%4m.profraw" ctest --preset coverage -L area -j "$(nproc)" || status=1
    llvm-profdata merge -failure-mode=all -o "$profiles/all.profdata" "$profiles"/*.profraw &&
        python3 -B tests/checks/coverage.py "$profiles/all.profdata" build/coverage/src/libsphgrad.so \
            build/coverage/tests/test_* build/coverage/tests/fuzz/fuzz_* &&
        return $status
}

# GCC's analyser and cppcheck do not follow vector extensions, so only clang-tidy sees the passes.
run_analyse() {
    local file status=0 plain
    plain=$(ls src/*/*.c | grep -v ^src/passes/)
    quietly cmake --preset clang -DSPHG_COMPILER_HAS_V4=ON || return 1 # whose options clang-tidy knows
    for file in $plain; do
        gcc -std=c11 -Iinclude -Isrc -DSPHG_HAVE_V3=1 -DSPHG_HAVE_V4=1 -DSPHG_USE_OPENMP=1 -fopenmp -O0 -fanalyzer -Werror \
            -c "$file" -o /dev/null || status=1
    done
    for file in src/*/*.c; do
        facts=(--extra-arg=-include --extra-arg="$PWD/tests/checks/analyser.h")
        case $file in src/core/context.c | src/api/context.c | src/core/check*.c | src/core/memory.c) facts=() ;; esac
        clang-tidy --quiet -p build/clang "${facts[@]}" "$file" 2>/dev/null || status=1
    done
    cppcheck --quiet --std=c11 --enable=warning,portability,performance --inconclusive \
        --inline-suppr --error-exitcode=1 -Iinclude -Isrc \
        -DSPHG_HAVE_V3=1 -DSPHG_HAVE_V4=1 -DSPHG_USE_OPENMP=1 -D__SSE2__=1 -D__GNUC__=12 $plain || status=1
    return $status
}
