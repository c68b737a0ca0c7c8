#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""documents.py ROOT CC [CXX]: what the pages tell a reader to do can be done. Blocks of C and C++ compile, whole
programs as they are, fragments beside documents/fragment.h. Blocks of CMake name targets and functions that exist.
Commands name scripts, their commands, presets, options and files that are there. Links lead somewhere."""
import glob
import json
import os
import re
import subprocess
import sys
import tempfile

root, compiler = sys.argv[1:3]
here = os.path.dirname(os.path.abspath(__file__))
failures = 0
counts = {"c": 0, "commands": 0, "links": 0, "options": 0}


def complain(page, text):
    global failures
    failures += 1
    print(f"{page}: {text}", file=sys.stderr)


def read(*path):
    with open(os.path.join(root, *path), encoding="utf-8") as file:
        return file.read()


def blocks(text):
    """(language, lines) of each fenced block, and "indented" for each run of lines with four spaces."""
    language, lines, quoted, previous = None, [], [], ""
    for line in text.splitlines() + [""]:
        if language is None and line.startswith("```"):
            language, lines = line[3:].strip(), []
        elif language is not None and line.startswith("```"):
            yield language, lines
            language = None
        elif language is not None:
            lines.append(line)
        elif line.startswith("    ") and (quoted or not previous.strip()):
            quoted.append(line[4:])
        else:
            if quoted:
                yield "indented", quoted
            quoted = []
        previous = line


# ---- C ------------------------------------------------------------------------------------------

def compile_c(page, code):
    counts["c"] += 1
    whole = re.search(r"\bmain\(", code)
    if not whole:
        code = (f'#include "{here}/documents/fragment.h"\nvoid fragment(void);\nvoid fragment(void)\n{{\n{code}\n}}\n')
    with tempfile.NamedTemporaryFile("w", suffix=".c", encoding="utf-8") as file:
        file.write(code)
        file.flush()
        done = subprocess.run([compiler, "-std=c11", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-Wno-unused",
                               "-I", os.path.join(root, "include"), file.name], capture_output=True, text=True)
    if done.returncode:
        complain(page, f"a block of C does not compile:\n{code}\n{done.stderr}")


# ---- Commands -----------------------------------------------------------------------------------

def help_of(script, *arguments):
    return subprocess.run([os.path.join(root, script), *arguments, "--help"], capture_output=True, text=True).stdout


SCRIPTS = ("bench/run", "bench/compare", "bench/peers/run", "examples/run", "tests/run", "docs/run")
helps = {script: help_of(script) for script in SCRIPTS}
presets = {preset["name"] for preset in json.loads(read("CMakePresets.json"))["configurePresets"]}
cmake_text = "\n".join(read(path) for path in ("CMakeLists.txt", "src/CMakeLists.txt", "src/bindings/CMakeLists.txt",
                                               "tests/CMakeLists.txt", "src/package/CMakeLists.txt")
                       if os.path.exists(os.path.join(root, path)))


def sources_in(*patterns):
    paths = [path for pattern in patterns for path in glob.glob(os.path.join(root, pattern))]
    return "\n".join(read(os.path.relpath(path, root)) for path in sorted(paths))


# Options of a command of the bench are known to the program, which need not be built here: to its sources.
bench_options = {os.path.basename(os.path.dirname(folder)): sources_in("bench/*.[ch]", "bench/particles/*.c",
                                                                       os.path.relpath(folder, root) + "/*.[ch]")
                 for folder in glob.glob(os.path.join(root, "bench/*/"))}
word_sources = {"examples/run": sources_in("examples/scenes/solver/*.c", "examples/distributed/*.c"),
                "tests/run": sources_in("tests/platforms/*.sh")}
targets = {"sphgrad::sphgrad", "sphgrad::cpp", "sphgrad::fortran"}


def check_options(page, text):
    for name in re.findall(r"-D([A-Z]\w+)", text) + re.findall(r"`(SPHG_(?:BUILD|OPENMP|INSTALL|EXPORT|WARN)\w*)`", text):
        counts["options"] += 1
        if name.startswith("SPHG_") and not re.search(rf"\b{name}\b", cmake_text):
            complain(page, f"there is no option {name}")


def is_named(word, text):
    return re.search(rf"(^|[\s,\[(]){re.escape(word)}(?![\w-])", text, re.M)


def is_read(word, sources):
    return re.search(rf"""["'(\s]{re.escape(word.removeprefix("--"))}["')\s]""", sources)


def check_script(page, script, words):
    """A script of ours: its help must know the command, the scene, the example or the option, or else the sources
    that read the words behind it."""
    known, sources = helps[script], ""
    if not known:
        return complain(page, f"{script} --help says nothing")
    if script == "bench/run":
        command = words[0] if words and words[0] in bench_options else "table1"
        sources = bench_options[command]
    elif script in word_sources:
        sources = word_sources[script]
    for number, word in enumerate(words):
        if word in ("--help", "-h"):
            continue
        word = word.strip("`'\",.;:)")
        if re.search(r"[A-Z./\[\]|]", word) or re.fullmatch(r"[\d.e+-]+", word):
            continue  # a placeholder, a file or a number
        word = re.sub(r"^(--[a-z0-9-]+)=.*$", r"\1", word)
        if number == 0 and not word.startswith("-"):
            if not is_named(word, known):
                complain(page, f"{script} has no command {word}")
        elif word and not is_named(word, known) and not is_read(word, sources):
            complain(page, f"{script} has no {word} behind {words[0]}")


def check_command(page, line):
    """A line of commands, perhaps with a remark behind two spaces."""
    line = re.split(r"  +", line.strip())[0]
    for command in re.split(r"&&|;", line):
        words = re.sub(r"^(\s*(sudo|nice|time|[A-Z_]+=\S*))+ ", "", command).split()
        if not words:
            continue
        counts["commands"] += 1
        first = words[0]
        if first in helps:
            check_script(page, first, words[1:])
        elif re.match(r"\.?/?[a-z_]+/", first) and not first.startswith("build/") and "*" not in first:
            if not os.path.exists(os.path.join(root, first)):
                complain(page, f"there is no {first}")
    for preset in re.findall(r"--preset[ =](\w[\w-]*)", line):
        if preset not in presets:
            complain(page, f"there is no preset {preset}")
    for area in re.findall(r"-R '\^(\w+)\$'", line):
        if not os.path.exists(os.path.join(root, f"tests/test_{area}.c")):
            complain(page, f"there is no area {area}")
    for path in re.findall(r"(?<![\w/$.-])((?:examples|tests|bench|docs|src|include)/[\w/.-]+\.\w+)", line):
        if not os.path.exists(os.path.join(root, path)):
            complain(page, f"there is no {path}")


# ---- Pages --------------------------------------------------------------------------------------

COMMANDS = re.compile(r"^((sudo|nice|time) |[A-Z_]+=\S* )*(tests/checks/|build/"
                      r"|((bench|examples|tests|docs)/[a-z_/]+|cmake|ctest|cc|c\+\+|gfortran|pip|python3)( |$))")




def anchors(text):
    for heading in re.findall(r"^#+ (.*)$", re.sub(r"```.*?```", "", text, flags=re.S), re.M):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        yield re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def check_links(page, text):
    prose = re.sub(r"```.*?```", "", text, flags=re.S)
    for target in re.findall(r"\]\(([^)\s]+)\)", prose):
        if re.match(r"https?:", target):
            continue
        counts["links"] += 1
        path, _, anchor = target.partition("#")
        file = os.path.normpath(os.path.join(root, os.path.dirname(page), path)) if path else os.path.join(root, page)
        if not os.path.exists(file):
            complain(page, f"the link {target} leads nowhere")
        elif anchor and anchor not in anchors(read(os.path.relpath(file, root))):
            complain(page, f"the link {target} names no heading")


def check_page(page):
    text = read(page)
    check_links(page, text)
    check_options(page, text)
    for language, lines in blocks(text):
        if language == "c":
            compile_c(page, "\n".join(lines))
        elif language in ("sh", "indented"):
            for line in "\n".join(lines).replace("\\\n", " ").splitlines():
                if language == "sh" or COMMANDS.match(line):
                    check_command(page, line)
        elif language == "cmake":
            for target in re.findall(r"\bsphgrad::\w+", "\n".join(lines)):
                if target not in targets:
                    complain(page, f"there is no target {target}")
        elif language not in ("cpp", "python", "fortran", "text", "bibtex"):  # these have tests of their own
            complain(page, f"a block of an unknown language: '{language}'")
    for words in re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", text, flags=re.S)):
        if COMMANDS.match(words):
            check_command(page, words)
    for path in re.findall(r"`((?:examples|tests|bench|docs|src|include)/[\w/.-]*[\w/])`", text):
        if "NAME" not in path and not os.path.exists(os.path.join(root, path)):
            complain(page, f"there is no {path}")


pages = sorted(os.path.relpath(path, root) for folder in ("", "docs", "tests", "bench", "bench/peers")
               for path in glob.glob(os.path.join(root, folder, "*.md")) if not path.endswith("CHANGELOG.md"))
for page in pages:
    check_page(page)
for kind, least in {"c": 15, "commands": 120, "links": 100, "options": 10}.items():
    if counts[kind] < least:
        complain("documents.py", f"only {counts[kind]} {kind} were found")
print(counts)
sys.exit(1 if failures else 0)
