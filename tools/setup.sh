# SPDX-License-Identifier: MIT
# Shared by bench/run, examples/run and tests/run (sourced by bash): packages, and builds that are quiet unless
# they fail or warn. A need is met if its probe works, from whichever package that came.

probe_compiler() {
    local out
    out=$(mktemp) || return 1
    printf '#include <math.h>\nint main(int n, char **v) { (void)v; return (int)sqrt(n - 1.0); }\n' |
        "$1" -x "$2" - -o "$out" -lm "${@:3}" >/dev/null 2>&1 && "$out"
    local status=$?
    rm -f "$out"
    return $status
}
probe_build_essential() { probe_compiler gcc c && probe_compiler g++ c++ && command -v make >/dev/null; }
probe_cmake() { command -v cmake >/dev/null; }
probe_ninja() { command -v ninja >/dev/null; }
probe_pkg_config() { command -v pkg-config >/dev/null; }
probe_cmocka() { pkg-config --exists cmocka 2>/dev/null; }
probe_lapacke() { pkg-config --exists lapacke 2>/dev/null; }
probe_cjson() { pkg-config --exists libcjson 2>/dev/null; }
# Particles that the examples write for ParaView.
probe_hdf5() { pkg-config --exists hdf5 2>/dev/null || pkg-config --exists hdf5-serial 2>/dev/null; }
probe_mpi() { command -v mpicc mpirun >/dev/null && printf '#include <mpi.h>\n' | mpicc -x c -fsyntax-only - 2>/dev/null; }
probe_zoltan() { printf '#include <zoltan.h>\n' | mpicc -x c -I/usr/include/trilinos -fsyntax-only - 2>/dev/null; }
probe_gnuplot() { gnuplot -e 'set terminal pngcairo' >/dev/null 2>&1; }
# probe_foreign TRIPLE QEMU [LANGUAGE...]: cross compilers, and what runs their programs.
probe_foreign() {
    local out status=0 language program='#include <math.h>
        int main(int n, char **v) { (void)v; return (int)sqrt(n - 1.0); }'
    out=$(mktemp) || return 1
    for language in "${@:3}"; do
        printf '%s\n' "$program" | "$1-$([ "$language" = c ] && echo gcc || echo g++)" -x "$language" - -o "$out" -lm \
            >/dev/null 2>&1 && "qemu-$2" -L "/usr/$1" "$out" >/dev/null 2>&1 || status=1
    done
    rm -f "$out"
    return $status
}
probe_aarch64() { probe_foreign aarch64-linux-gnu aarch64 c c++; }
probe_cross_i386() { probe_foreign i686-linux-gnu i386 c; }
probe_cross_s390x() { probe_foreign s390x-linux-gnu s390x c; }
probe_cross_riscv64() { probe_foreign riscv64-linux-gnu riscv64 c; }
probe_cross_ppc64el() { probe_foreign powerpc64le-linux-gnu ppc64le c; }
probe_cross_armhf() { probe_foreign arm-linux-gnueabihf arm c; }
probe_cross_windows() { command -v x86_64-w64-mingw32-gcc >/dev/null && command -v wine >/dev/null; }
probe_musl() { probe_compiler musl-gcc c; }
probe_gcc_11() { probe_compiler gcc-11 c; }
# Of the packages: what makes them, and what judges them.
probe_debian_packages() { command -v lintian >/dev/null && command -v dpkg-shlibdeps >/dev/null; }
probe_clang() { probe_compiler clang c && probe_compiler clang++ c++; }
probe_clang_openmp() { probe_compiler clang c -fopenmp; }
# What its sanitizers, fuzzers and counters link with: a package of its own, recommended only.
probe_clang_runtime() { probe_clang && probe_compiler clang c -fsanitize=address,undefined; }
# Of tests/run --coverage, --analyse, --valgrind and --mutants alone.
probe_llvm() { command -v llvm-cov llvm-profdata >/dev/null; }
probe_clang_tidy() { command -v clang-tidy >/dev/null; }
probe_cppcheck() { command -v cppcheck >/dev/null; }
probe_valgrind() { valgrind -q true 2>/dev/null; }
probe_python3() { python3 -c '' 2>/dev/null; }
probe_doxygen() { command -v doxygen >/dev/null; }
probe_eigen() { pkg-config --exists eigen3 2>/dev/null; }
probe_fortran() { printf 'end\n' | gfortran -x f95 - -o /dev/null 2>/dev/null; }
# python_with MODULE...: prints the first Python that has them, that of the path or the system's.
python_with() {
    local python modules=$*
    for python in python3 /usr/bin/python3; do
        "$python" -c "import ${modules// /, }" 2>/dev/null && echo "$python" && return 0
    done
    return 1
}
# Of the Python package and its wheel; of the package alone.
probe_numpy() { python_with numpy scipy setuptools wheel pip >/dev/null; }
probe_python_arrays() { python_with numpy >/dev/null; }

package_of() {
    case $1 in
        build_essential) echo build-essential ;;
        cmake) echo cmake ;;
        ninja) echo ninja-build ;;
        pkg_config) echo pkg-config ;;
        cmocka) echo libcmocka-dev ;;
        lapacke) echo liblapacke-dev ;;
        cjson) echo libcjson-dev ;;
        hdf5) echo libhdf5-dev ;;
        mpi) printf '%s\n' libopenmpi-dev openmpi-bin ;;
        zoltan) echo libtrilinos-zoltan-dev ;;
        gnuplot) echo gnuplot-nox ;;
        aarch64) printf '%s\n' gcc-aarch64-linux-gnu g++-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user ;;
        cross_i386) printf '%s\n' gcc-i686-linux-gnu libc6-dev-i386-cross qemu-user ;;
        cross_s390x) printf '%s\n' gcc-s390x-linux-gnu libc6-dev-s390x-cross qemu-user ;;
        cross_riscv64) printf '%s\n' gcc-riscv64-linux-gnu libc6-dev-riscv64-cross qemu-user ;;
        cross_ppc64el) printf '%s\n' gcc-powerpc64le-linux-gnu libc6-dev-ppc64el-cross qemu-user ;;
        cross_armhf) printf '%s\n' gcc-arm-linux-gnueabihf libc6-dev-armhf-cross qemu-user ;;
        cross_windows) printf '%s\n' gcc-mingw-w64-x86-64 wine wine64 ;;
        musl) echo musl-tools ;;
        gcc_11) echo gcc-11 ;;
        debian_packages) printf '%s\n' dpkg-dev lintian ;;
        clang) echo clang ;;
        clang_openmp) echo libomp-dev ;;
        clang_runtime) echo libclang-rt-dev ;;
        llvm) echo llvm ;;
        clang_tidy) echo clang-tidy ;;
        cppcheck) echo cppcheck ;;
        valgrind) printf '%s\n' valgrind libc6-dbg ;;
        python3) echo python3 ;;
        fortran) echo gfortran ;;
        doxygen) echo doxygen ;;
        eigen) echo libeigen3-dev ;;
        python_arrays) echo python3-numpy ;;
        numpy) printf '%s\n' python3-numpy python3-scipy python3-pip python3-setuptools python3-wheel ;;
    esac
}

missing_packages() {
    local need
    for need; do
        "probe_$need" || package_of "$need"
    done
}

# explain_packages REASON PACKAGE...: the one line for those who must install by themselves.
explain_packages() {
    echo "sphgrad needs, by their Debian names: ${*:2}. Please install them: $1." >&2
    return 1
}

install_packages() {
    local log as_root=()
    if ! command -v apt-get >/dev/null; then
        explain_packages 'there is no apt-get here to do it' "$@"
        return 1
    fi
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null; then
            explain_packages 'this user is not root and there is no sudo' "$@"
            return 1
        fi
        as_root=(sudo)
        [ -t 0 ] || as_root=(sudo -n)
    fi
    echo "installing $*" >&2
    log=$(mktemp) || return 1
    if "${as_root[@]}" apt-get update >"$log" 2>&1 &&
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
            apt-get install -y --no-install-recommends "$@" >>"$log" 2>&1; then
        rm -f "$log"
        return 0
    fi
    tail -n 20 "$log" >&2
    rm -f "$log"
    explain_packages 'apt-get could not (see above)' "$@"
}

# require_packages NEED...: installs what is missing, touches nothing (no network) if all is there.
require_packages() {
    local packages version
    mapfile -t packages < <(missing_packages "$@")
    if [ ${#packages[@]} -gt 0 ]; then
        install_packages "${packages[@]}" || return 1
        mapfile -t packages < <(missing_packages "$@")
        if [ ${#packages[@]} -gt 0 ]; then
            explain_packages 'apt-get did, but they do not work' "${packages[@]}"
            return 1
        fi
    fi
    version=$(cmake --version | sed -n '1s/.* //p')
    if [ "$(printf '%s\n3.22\n' "$version" | sort -V | head -n 1)" != 3.22 ]; then
        echo "sphgrad needs CMake 3.22 or newer, this is $version (Debian 12, Ubuntu 22.04 have it)" >&2
        return 1
    fi
}

# quietly COMMAND...: the output is shown only if the command fails, and what it warned of.
quietly() {
    local log
    log=$(mktemp) || return 1
    if "$@" >"$log" 2>&1; then
        grep -A 4 'warning:' "$log" >&2
        rm -f "$log"
        return 0
    fi
    grep -vE '^\[ *[0-9]+(%|/[0-9]+)\] ' "$log" >&2 # less the progress
    rm -f "$log"
    echo "failed: $*" >&2
    return 1
}

# build_preset PRESET [CONFIGURE OPTION...] [-- BUILD OPTION...], from the root of the sources. Where Ninja is
# installed, a new build uses it: it compiles the tests while the library is compiled, and takes no time itself.
build_preset() {
    local preset=$1 configure=()
    shift
    if [ ! -f "build/$preset/CMakeCache.txt" ] && probe_ninja; then
        configure+=(-G Ninja)
    fi
    while [ $# -gt 0 ] && [ "$1" != -- ]; do
        configure+=("$1")
        shift
    done
    [ $# -eq 0 ] || shift
    quietly cmake --preset "$preset" "${configure[@]}" &&
        quietly cmake --build --preset "$preset" -j "$(nproc)" "$@"
}
