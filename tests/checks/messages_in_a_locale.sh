#!/bin/sh
# SPDX-License-Identifier: MIT
# messages_in_a_locale.sh TEST_ERRORS: in a host with decimal commas messages have decimal points, and
# numbers that read back. Skips (77) where no such locale can be made.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
localedef -i de_DE -f UTF-8 "$work/de_DE.UTF-8" >"$work/log" 2>&1
if [ "$(LOCPATH=$work LC_ALL=de_DE.UTF-8 locale decimal_point 2>/dev/null)" != , ]; then
    echo "skipped: localedef makes no de_DE: $(head -c 200 "$work/log")"
    exit 77
fi
LOCPATH=$work SPHG_TEST_LOCALE=de_DE.UTF-8 "$1" 'messages_print*'
