#!/bin/sh
# SPDX-License-Identifier: MIT
# stage.sh CMAKE BUILD PREFIX: installs a build and moves the result to PREFIX.
set -eu
cmake=$1 build=$2 prefix=$3
rm -rf "$prefix" "$prefix.first"
"$cmake" --install "$build" --prefix "$prefix.first"
mv "$prefix.first" "$prefix"
