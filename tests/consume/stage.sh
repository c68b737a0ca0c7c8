#!/bin/sh
# stage.sh CMAKE BUILD PREFIX [CONFIGURE OPTION...]: installs a build and moves the result to PREFIX.
# With options, the build is configured and made first.
set -eu
cmake=$1 build=$2 prefix=$3
shift 3
if [ $# -gt 0 ]; then
    "$cmake" -B "$build" "$@"
    "$cmake" --build "$build"
fi
rm -rf "$prefix" "$prefix.first"
"$cmake" --install "$build" --prefix "$prefix.first"
mv "$prefix.first" "$prefix"
