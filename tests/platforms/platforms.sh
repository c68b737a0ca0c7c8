# SPDX-License-Identifier: MIT
# tests/run --platforms [NAME...] (sourced by tests/more.sh): each platform builds the library as a host
# does, with warnings as errors, and runs smoke.c; all of them if none is named. What is built for another
# machine is run by qemu or wine. gcc-11, the compiler of Ubuntu 22.04, builds benchmark, tests and examples, too.
# Hashes that are known beforehand: of what does not fuse products and sums, and of what does. The last column says
# which of them the base set must have; v3 and v4 have the second everywhere. Where the order of a sum, or smoke.c, is
# changed on purpose, the new ones are those that are printed.
hash_of_base=2e562605846e8bf4
hash_of_fused=1267d0618bc354ef

# name | C compiler | system, processor (of another machine) | options of CMake | what runs it | bits
platform_table() {
    sed 's/ *| */|/g' <<'END'
native   | cc                        |                | -DSPHG_COMPILER_HAS_V3=OFF -DSPHG_COMPILER_HAS_V4=OFF | | base
gcc-11   | gcc-11                    |                | -DBUILD_SHARED_LIBS=ON -DCMAKE_CXX_COMPILER=g++-11 -DALL_PARTS=ON | | base
native-march | cc                    |                | -DCMAKE_C_FLAGS=-march=native -DSPHG_COMPILER_HAS_V3=OFF -DSPHG_COMPILER_HAS_V4=OFF | | base
clang    | clang                     |                | -DSPHG_OPENMP=OFF | | base
musl     | musl-gcc                  |                | -DSPHG_OPENMP=OFF -DSPHG_COMPILER_HAS_V3=OFF -DSPHG_COMPILER_HAS_V4=OFF -DCMAKE_EXE_LINKER_FLAGS=-static | | base
i386     | i686-linux-gnu-gcc        | Linux i686     | -DSPHG_OPENMP=OFF | qemu-i386 -L /usr/i686-linux-gnu | own
i386-sse | i686-linux-gnu-gcc        | Linux i686     | -DSPHG_OPENMP=OFF -DCMAKE_C_FLAGS=-msse2;-mfpmath=sse | qemu-i386 -L /usr/i686-linux-gnu | base
s390x    | s390x-linux-gnu-gcc       | Linux s390x    | | qemu-s390x -L /usr/s390x-linux-gnu | fused
riscv64  | riscv64-linux-gnu-gcc     | Linux riscv64  | | qemu-riscv64 -L /usr/riscv64-linux-gnu | fused
ppc64el  | powerpc64le-linux-gnu-gcc | Linux ppc64le  | | qemu-ppc64le -L /usr/powerpc64le-linux-gnu | fused
armhf    | arm-linux-gnueabihf-gcc   | Linux armv7l   | | qemu-arm -L /usr/arm-linux-gnueabihf | base
arm64    | aarch64-linux-gnu-gcc     | Linux aarch64  | | qemu-aarch64 -L /usr/aarch64-linux-gnu | fused
arm64-clang | clang                  | Linux aarch64  | -DSPHG_OPENMP=OFF -DCMAKE_C_FLAGS=--target=aarch64-linux-gnu | qemu-aarch64 -L /usr/aarch64-linux-gnu | fused
windows  | x86_64-w64-mingw32-gcc    | Windows x86_64 | -DBUILD_SHARED_LIBS=ON | run_by_wine | base
windows-static | x86_64-w64-mingw32-gcc | Windows x86_64 | -DSPHG_COMPILER_HAS_V3=OFF -DSPHG_COMPILER_HAS_V4=OFF | run_by_wine | base
msvc     | clang                     |                | | the header alone | none
END
}

# platform_row NAME: its columns into the variables of that name.
platform_row() {
    local row
    row=$(platform_table | grep "^$1|") || return 1
    IFS='|' read -r _ compiler machine options runner bits <<<"$row"
    # the rows for this machine are written for x86-64; other machines fuse
    [ -n "$machine" ] || [ "$bits" != base ] || [ "$(uname -m)" = x86_64 ] || bits=fused
}

platform_names() { platform_table | cut -d '|' -f 1; }

# needs_of_platforms NAME...: cmake, and what compiles for them and runs that.
needs_of_platforms() {
    local name
    printf '%s\n' build_essential cmake
    for name in ${*:-$(platform_names)}; do
        platform_names | grep -qxFe "$name" || continue # refused below
        case $name in
            native | native-march) ;;
            i386*) echo cross_i386 ;;
            windows*) echo cross_windows ;;
            gcc-11) printf '%s\n' gcc_11 cmocka lapacke cjson hdf5 ;;
            arm64) echo aarch64 ;;
            arm64-clang) printf '%s\n' aarch64 clang ;;
            msvc | clang) echo clang ;;
            musl) echo musl ;;
            *) echo "cross_$name" ;;
        esac
    done | sort -u
}

# Its own home, and no word of what it has not got. The libraries of the compiler lie beside the compiler.
run_by_wine() {
    local folder file
    folder=$(dirname "$1")
    for file in libgomp-1.dll libgcc_s_seh-1.dll; do
        cp "$(x86_64-w64-mingw32-gcc -print-file-name=$file)" "$folder" || return 1
    done
    cp "$(dirname "$(x86_64-w64-mingw32-gcc -print-sysroot)")/lib/libwinpthread-1.dll" "$folder" 2>/dev/null ||
        cp /usr/x86_64-w64-mingw32/lib/libwinpthread-1.dll "$folder" || return 1
    WINEPREFIX=$PWD/build/platforms/wine WINEDEBUG=-all WINEDLLOVERRIDES='mscoree=;mshtml=' wine "$@" | tr -d '\r'
    return "${PIPESTATUS[0]}"
}

# read_header HEADER: as a compiler of Windows that knows nothing of GCC, and has no C library here, does, as C11 and
# C++11, of a static and a shared library.
read_header() {
    local target language macro
    for target in x86_64 i686 aarch64; do
        for language in c11:c c++11:c++ c++20:c++; do
            for macro in SPHG_STATIC SPHG_SHARED SPHG_SHARED_BUILD; do
                clang --target=$target-pc-windows-msvc -fms-compatibility -fms-extensions -U__GNUC__ -fsyntax-only -Werror \
                    -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wundef -D$macro -Iinclude \
                    -idirafter tests/platforms/without_libc -DPUBLIC_HEADER="<$1>" -std=${language%:*} -x ${language#*:} tests/checks/header_alone.c || return 1
            done
        done
    done
}

check_msvc() {
    local header
    for header in include/sphgrad/*.h; do
        read_header "${header#include/}" || return 1
    done
    echo 'the headers are read'
}

# build_platform: the platform whose row was read, into $folder.
build_platform() {
    local words=(-DCMAKE_C_COMPILER="$compiler") word
    [ -z "$machine" ] || words+=(-DCMAKE_SYSTEM_NAME="${machine% *}" -DCMAKE_SYSTEM_PROCESSOR="${machine#* }")
    [ -f "$folder/CMakeCache.txt" ] || ! probe_ninja || words+=(-G Ninja)
    for word in $options; do
        words+=("${word//;/ }")
    done
    quietly cmake -S tests/platforms -B "$folder" -DSPHG_OPENMP=ON "${words[@]}" &&
        quietly cmake --build "$folder" -j "$(nproc)"
}

# try_platform NAME: its hashes on stdout, one a line behind the name of the instruction set.
try_platform() {
    local compiler machine options runner bits folder=build/platforms/$1 program
    platform_row "$1" || return 1
    [ "$1" != msvc ] || { check_msvc; return; }
    build_platform || return 1
    program=$folder/smoke
    [ -f "$program" ] || program=$program.exe
    $runner "$program"
}

# wrong_hashes: of a platform's output, with $bits of its row, the sets whose hash is not the one that is known.
wrong_hashes() {
    awk -v base="$hash_of_base" -v fused="$hash_of_fused" -v bits="$bits" '
        $1 == "base" && bits == "own" { next }
        $1 ~ /^(base|v3|v4)$/ && $2 "" != "" ($1 == "base" && bits == "base" ? base : fused) { print $1 }'
}

# run_platforms NAME...
run_platforms() {
    local name names="$*" output wrong passed=0 failed=() compiler machine options runner bits
    for name; do
        platform_row "$name" || { echo "tests/run: there is no platform '$name'; there are:" $(platform_names) >&2; return 2; }
    done
    for name in ${names:-$(platform_names)}; do
        platform_row "$name"
        output=$(try_platform "$name") || { echo "$name: FAILED"; echo "$output"; failed+=("$name"); continue; }
        wrong=$(wrong_hashes <<<"$output")
        if [ -n "$wrong" ]; then
            echo "$name: not the bits that are known:" $wrong
            failed+=("$name")
        fi
        printf '%-15s %s\n' "$name" "$(paste -sd ' ' <<<"$output")"
        passed=$((passed + 1))
    done
    [ ${#failed[@]} -eq 0 ] || echo "not green: ${failed[*]}"
    echo "$passed passed, ${#failed[@]} failed"
    [ ${#failed[@]} -eq 0 ]
}
