#!/bin/sh
# layers.sh ROOT: the library's files stand in layers, and each may include its own and lower ones.
# The public header is what all of them serve: everyone may include it, it includes the standard.
cd "$1" || exit 1

layer_of() {
    case $1 in
        evaluate.c | pairs.c | neighbors.c | list_check.c | entries.h | small_matrices.c) echo 4 ;;
        plan.* | plan_fields.c | plan_views.c | plan_sums.* | units.* | making.h | selection.* | tally.* | worker.* | clean.* | group.c | corrections.* | finish.* | sums.* | stage.* | traverse.* | sweep.* | svd.*) echo 3 ;;
        neighbors.h | places.* | skin.* | find.* | lists.* | grid.* | lattice.c | sort.c | surroundings.c) echo 3 ;;
        context.* | check.* | view.* | kernel.* | kernel_list.h | parallel.* | memory.* | cpu.* | result.* | digits.* | float_environment.*) echo 2 ;;
        passes/*) echo 1 ;;
        internal.h) echo 0 ;;
    esac
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
        done | sed 's|^\./||'
}

files=$(cd src && find . -name '*.[ch]' | sed 's|^\./||' | sort)
[ -n "$files" ] || complain "src holds no sources"
for file in $files; do
    layer=$(layer_of "$file")
    if [ -z "$layer" ]; then
        complain "src/$file stands in no layer"
        continue
    fi
    for name in $(included "$file"); do
        below=$(layer_of "$name")
        if [ -z "$below" ]; then
            complain "src/$file includes \"$name\", which stands in no layer"
        elif [ "$below" -gt "$layer" ]; then
            complain "src/$file (layer $layer) includes $name (layer $below)"
        fi
    done
done

if grep -rn --include='*.[ch]' -E 'include *<omp\.h>|pragma omp' src | grep -v '^src/parallel\.c:' >&2; then
    complain "OpenMP is parallel.c's alone"
fi
if grep -n --include='*.[ch]' -rE '"[^"]*%[-+ #0-9.*]*l?[aefgAEFG]' src | grep -v '^src/digits\.c:' >&2; then
    complain "numbers are printed by digits.c alone"
fi
if grep -n '#include "' include/sphgrad/sphgrad.h >&2; then
    complain "the public header includes a file of ours"
fi
exit $status
