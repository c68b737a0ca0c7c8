#!/bin/sh
# SPDX-License-Identifier: MIT
# help.sh SOURCES BENCH EXAMPLES: --help and -h of every program and script answer on stdout with status 0, the
# scripts without building anything; `examples/run` knows every example and every scene.
sources=$1 bench=$2 examples=$3
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
status=0

complain() {
    echo "$*" >&2
    status=1
}

# helps PATTERN COMMAND...: with --help and with -h.
helps() {
    pattern=$1
    shift
    for option in --help -h; do
        "$@" $option >"$work/output" 2>"$work/errors" || complain "$* $option: status $?"
        [ ! -s "$work/errors" ] || complain "$* $option: on stderr: $(cat "$work/errors")"
        grep -qE -e "$pattern" "$work/output" || complain "$* $option: no line matches '$pattern'"
    done
}

# The scripts in a tree where nothing can be built.
tree=$work/tree
mkdir -p "$tree/tools" "$tree/bench" "$tree/examples/scenes" "$tree/tests"
cp "$sources/bench/run" "$sources/bench/main.c" "$tree/bench"
cp "$sources/examples/run" "$sources/examples/CMakeLists.txt" "$sources"/examples/*.c "$tree/examples"
for language in cpp fortran python; do
    cp -R "$sources/examples/$language" "$tree/examples"
done
cp "$sources/examples/scenes/CMakeLists.txt" "$sources"/examples/scenes/*.c "$tree/examples/scenes"
cp "$sources/tests/run" "$sources/tests/more.sh" "$tree/tests"
cp -R "$sources/tests/platforms" "$sources/tests/packages" "$tree/tests"
cat >"$tree/tools/setup.sh" <<'END'
require_packages() { [ -e "$source_dir/may_build" ] || { echo "asks for packages" >&2; return 1; }; }
build_preset() { [ -e "$source_dir/may_build" ] || { echo "builds" >&2; return 1; }; }
END
helps '^  bench/run COMMAND' "$tree/bench/run"
helps '^  bench/run COMMAND' "$tree/bench/run" limit
helps '^  bench/run COMMAND' "$tree/bench/run" stability --quick
helps '^  examples/run SCENE' "$tree/examples/run"
helps '^  examples/run film SCENE' "$tree/examples/run" film dam_break
helps '^  examples/run SCENE' "$tree/examples/run" all
helps '^  examples/run SCENE' "$tree/examples/run" cube --seed 2
helps '^  --all ' "$tree/tests/run"
helps '^  --all ' "$tree/tests/run" --mutants 5

# Commands: those of the program, with its words.
helps '^ *table1 ' "$bench"
"$bench" --help | sed -n 's/^  \([a-z]\)/\1/p' >"$work/program"
"$tree/bench/run" --help | sed -n '/^Commands/,$s/^  \([a-z]\)/\1/p' >"$work/script"
diff "$work/program" "$work/script" >&2 || complain 'bench/run --help does not list what sphgrad-bench --help does'
while read -r command summary; do
    helps '^Usage: ' "$bench" "$command"
done <"$work/program"
[ "$(wc -l <"$work/program")" -gt 6 ] || complain 'the program lists few commands'

# Scenes: every program that was built, with a line about it, and every option.
"$tree/examples/run" --help >"$work/script"
scenes=0
for program in "$examples"/scenes/*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    scene=$(basename "$program")
    [ -f "$sources/examples/scenes/$scene.c" ] || continue
    scenes=$((scenes + 1))
    grep -qE "^  $scene +[A-Z].{20}" "$work/script" || complain "examples/run --help has no line on $scene"
    helps '^  examples/run SCENE' "$tree/examples/run" "$scene"
    helps '^Usage: ' "$program"
done
[ "$scenes" -gt 6 ] || complain "$scenes scenes"
# Examples: every source, with its first sentence.
for source in "$sources"/examples/*.c "$sources"/examples/*/*.cpp "$sources"/examples/*/*.f90 "$sources"/examples/*/*.py; do
    example=${source#"$sources"/examples/}
    grep -qE "^  ${example%.*} +[A-Z].{20}" "$work/script" || complain "examples/run --help has no line on $example"
    case $example in
        *.f90 | *.py) ;; # where their tools are
        *) [ -x "$examples/${example%.*}" ] || complain "$example was not built" ;;
    esac
done
for option in $("$examples/scenes/cube" --help | grep -oE -e '--[a-z]+' | grep -vE 'help|usage|version' | sort -u); do
    grep -q -e "$option" "$work/script" || complain "examples/run --help does not know $option"
done

# What is run: an example, all of them, a scene, and nothing else.
touch "$tree/may_build"
mkdir -p "$tree/build/examples"
ln -s "$examples" "$tree/build/examples/examples"
"$tree/examples/run" gradient | grep -q '^dvx/dy = -[01]\.' || complain 'examples/run gradient does not run'
"$tree/examples/run" rest_configuration | grep -q . || complain 'examples/run rest_configuration does not run'
[ ! -x "$examples/fortran/gradient" ] || "$tree/examples/run" fortran/gradient | grep -q '^dvx/dy = *-1\.' ||
    complain 'examples/run fortran/gradient does not run'
"$tree/examples/run" small | grep -c '^== ' | grep -qE '^[0-9]{2}$' || complain 'examples/run small does not run'
"$tree/examples/run" vorticity --method sph --alone | grep -q '"scene": "vorticity"' || complain 'no scene runs'
rm "$tree/may_build"

# refuses PATTERN COMMAND...: with status 2, on stderr alone, before anything is built.
refuses() {
    pattern=$1
    shift
    "$@" >"$work/output" 2>"$work/errors"
    code=$?
    [ "$code" -eq 2 ] || complain "$*: status $code instead of 2"
    [ ! -s "$work/output" ] || complain "$*: on stdout: $(cat "$work/output")"
    grep -qE -e "$pattern" "$work/errors" || complain "$*: no line matches '$pattern'"
}
refuses '^  examples/run SCENE' "$tree/examples/run"
for wrong in gradients 'normals grid' solver help --nonsense; do
    refuses "^there is no example or scene $wrong; there are: gradient wall" "$tree/examples/run" "$wrong"
done
refuses '^one at a time' "$tree/examples/run" normals grid
refuses "^bench/run: there is no command 'limits'" "$tree/bench/run" limits
refuses '^  bench/run COMMAND' "$tree/bench/run" help
refuses "^tests/run: there is no option 'quick'" "$tree/tests/run" quick
refuses '^  --all ' "$tree/tests/run" --all --nonsense
exit $status
