# SPDX-License-Identifier: MIT
# tests/run --packages (sourced by tests/more.sh): Debian's packages as CPack makes them, judged by lintian,
# unpacked and compiled against, and made again in a folder of another name: the same bits.
needs_of_packages() { printf '%s\n' build_essential cmake pkg_config debian_packages; }

# make_packages SOURCES: into SOURCES/build/package.
make_packages() {
    local fresh=()
    [ -f "$1/build/package/CMakeCache.txt" ] || ! probe_ninja || fresh=(-G Ninja)
    (cd "$1" && quietly cmake --preset package "${fresh[@]}" &&
        quietly cmake --build --preset package -j "$(nproc)" && cd build/package && rm -f ./*.deb && quietly cpack)
}

# What Debian asks of an upload, such as a bug that it closes, is not asked of these.
judge_packages() {
    lintian --allow-root --fail-on error --tag-display-limit 0 \
        --suppress-tags initial-upload-closes-no-bugs,bogus-mail-host "$@"
}

# declare_packages PACKAGE...: on what each depends, and that other architectures may stand beside it.
declare_packages() {
    local package
    for package; do
        dpkg-deb --field "$package" Depends | grep -qE '^(libc6|libsphgrad)' &&
            [ "$(dpkg-deb --field "$package" Multi-Arch)" = same ] || { echo "$package: wrong fields" >&2; return 1; }
    done
}

# use_packages FOLDER PACKAGE...: apt could install them, and a program compiles and runs with what they hold.
use_packages() {
    local root=$1 package multiarch
    shift
    apt-get install --simulate --no-install-recommends "${@/#/./}" >/dev/null || return 1
    rm -rf "$root" && mkdir -p "$root" || return 1
    for package; do
        dpkg-deb --extract "$package" "$root" || return 1
    done
    multiarch=usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)
    gcc tests/consume/c/linear_field.c -o "$root/linear_field" -lm \
        $(PKG_CONFIG_LIBDIR="$root/$multiarch/pkgconfig" pkg-config --cflags --libs sphgrad) &&
        LD_LIBRARY_PATH=$root/$multiarch "$root/linear_field" || return 1
    echo 'a program compiles and runs with them'
}

run_packages() {
    local again made
    again=$(mktemp -d) || return 1
    make_packages "$PWD" || return 1
    made=(build/package/*.deb)
    judge_packages "${made[@]}" && declare_packages "${made[@]}" && use_packages "$PWD/build/package/unpacked" "${made[@]}" || return 1
    mkdir "$again/elsewhere" && git ls-files -z --cached --others --exclude-standard | tar -c --null -T - | tar -x -C "$again/elsewhere" &&
        make_packages "$again/elsewhere" || return 1
    for package in "${made[@]}"; do
        same_contents "$package" "$again/elsewhere/$package" || return 1
    done
    rm -rf "$again"
    echo "${#made[@]} passed, 0 failed"
}

# same_contents PACKAGE PACKAGE: byte for byte what they install.
same_contents() {
    [ "$(contents "$1")" = "$(contents "$2")" ] || { echo "$(basename "$1"): other bits from another folder" >&2; return 1; }
    echo "$(basename "$1"): the same bits from two folders"
}
contents() { dpkg-deb --fsys-tarfile "$1" | tar -x --to-command='sha256sum | sed "s|-|$TAR_FILENAME|"'; }
