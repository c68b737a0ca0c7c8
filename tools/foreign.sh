# SPDX-License-Identifier: MIT
# Libraries for another architecture (sourced by tests/run behind setup.sh): Debian's own packages, unpacked
# into a folder of the build. The system keeps its one architecture, and nothing here needs root.

# foreign_apt ROOT ARCHITECTURE COMMAND...: apt-get that knows the system's sources, and an empty system.
foreign_apt() {
    local root=$1 architecture=$2
    apt-get -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" \
        -o Dir::State="$root/apt" -o Dir::State::status="$root/apt/status" -o Dir::Cache="$root/apt" \
        -o Debug::NoLocking=1 -o APT::Sandbox::User="" -o Acquire::Languages=none \
        -o APT::Get::Assume-Yes=1 -o APT::Install-Recommends=0 "${@:3}"
}

# unpack_foreign ROOT ARCHITECTURE PACKAGE...: the packages and all that they depend on.
unpack_foreign() {
    local root=$1 architecture=$2 archive
    rm -rf "$root"
    mkdir -p "$root/apt/lists/partial" "$root/apt/archives/partial" && : >"$root/apt/status" || return 1
    # A source without this architecture is an error of update; what counts is what can be fetched.
    foreign_apt "$root" "$architecture" update
    foreign_apt "$root" "$architecture" --download-only install "${@:3}" || return 1
    for archive in "$root"/apt/archives/*.deb; do
        dpkg-deb --extract "$archive" "$root" || return 1
    done
    rm -rf "$root/apt"
    link_alternatives "$root"/usr/lib/*-linux-gnu*/
}

# link_alternatives FOLDER: BLAS and LAPACK where installing them would have put links.
link_alternatives() {
    local name
    for name in blas lapack; do
        [ -d "$1/$name" ] || continue
        (cd "$1" && ln -s "$name"/*.so* . && ln -s "$name-netlib.pc" "pkgconfig/$name.pc") || return 1
    done
}

# require_foreign ROOT ARCHITECTURE PACKAGE...: as unpack_foreign, unless they are there. ROOT is absolute.
require_foreign() {
    local list="$2 ${*:3}" log
    [ "$(cat "$1/packages.txt" 2>/dev/null)" != "$list" ] || return 0
    if ! command -v apt-get >/dev/null || ! command -v dpkg-deb >/dev/null; then
        echo "sphgrad needs these packages of Debian for $2: ${*:3}. There is no apt-get to fetch them." >&2
        return 1
    fi
    echo "fetching for $2: ${*:3}" >&2
    log=$(mktemp) || return 1
    if unpack_foreign "$@" >"$log" 2>&1; then
        rm -f "$log"
        echo "$list" >"$1/packages.txt"
        return 0
    fi
    tail -n 20 "$log" >&2
    rm -f "$log"
    echo "sphgrad needs these packages of Debian for $2: ${*:3}. apt-get could not fetch them (see above)." >&2
    return 1
}
