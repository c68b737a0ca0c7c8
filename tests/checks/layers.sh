#!/bin/sh
# layers.sh ROOT: the folders of src are layers, and each file may include its own folder and those below it.
# The public header is what all of them serve: everyone may include it, it includes the standard.
cd "$1" || exit 1

# From the lowest; src/README.md shows them. Every folder may include those named before it.
order="internal.h passes core search plan sweep api"

# height_of PATH: the place of its folder (of internal.h: its own) in the order.
height_of() {
    place=0
    for folder in $order; do
        place=$((place + 1))
        [ "$folder" != "${1%%/*}" ] || echo $place
    done
}

status=0
complain() {
    echo "$*" >&2
    status=1
}

# included FILE: what FILE includes in quotes, as paths from src/.
included() {
    sed -n 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*"\([^"]*\)".*/\1/p' "src/$1" |
        while read -r name; do
            if [ -f "src/$(dirname "$1")/$name" ]; then
                echo "$(dirname "$1")/$name"
            else
                echo "$name"
            fi
        done
}

files=$(cd src && find . -name '*.[ch]' | sed 's|^\./||' | sort)
[ -n "$files" ] || complain "src holds no sources"
for file in $files; do
    height=$(height_of "$file")
    if [ -z "$height" ]; then
        complain "src/$file stands in no layer"
        continue
    fi
    for name in $(included "$file"); do
        below=$(height_of "$name")
        if [ -z "$below" ] || [ ! -f "src/$name" ]; then
            complain "src/$file includes \"$name\", which is no file of a layer"
        elif [ "$below" -gt "$height" ]; then
            complain "src/$file includes $name, which stands above it"
        fi
    done
done
for folder in $order; do
    [ -e "src/$folder" ] || complain "src/$folder is named as a layer and is not there"
    grep -q "$folder" src/README.md || complain "src/README.md does not show $folder"
done

if grep -rn --include='*.[ch]' -E 'include *<omp\.h>|pragma omp' src | grep -v '^src/core/parallel\.c:' >&2; then
    complain "OpenMP is parallel.c's alone"
fi
if grep -n --include='*.[ch]' -rE '"[^"]*%[-+ #0-9.*]*l?[aefgAEFG]' src | grep -v '^src/core/digits\.c:' >&2; then
    complain "numbers are printed by digits.c alone"
fi
if grep -n '#include "' include/sphgrad/sphgrad.h >&2; then
    complain "the public header includes a file of ours"
fi
exit $status
