#!/bin/sh
# SPDX-License-Identifier: MIT
# wheel.sh CMAKE BUILD WORK PYTHON PROGRAM: the target python_wheel makes one wheel, pip installs it without a
# network, and PROGRAM finds package and library there.
set -eu
cmake=$1 build=$2 work=$3 python=$4 program=$5
for module in pip setuptools wheel numpy; do
    "$python" -c "import $module" 2>/dev/null || { echo "skipped: this Python has no $module"; exit 77; }
done
rm -rf "$work" "$build/wheels"
"$cmake" --build "$build" --target python_wheel
[ "$(ls "$build/wheels" | wc -l | tr -d ' ')" = 1 ]
# An option that pip has since 22.1; older ones do not mind a variable that they do not know.
PIP_ROOT_USER_ACTION=ignore "$python" -m pip install --quiet --no-index --no-deps --target "$work" "$build"/wheels/*.whl
cd /
env -u SPHGRAD_LIBRARY PYTHONPATH="$work" "$python" -B "$program" "$work"
