#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lines and branches of the library's sources that the tests reach, and those they do not.

    coverage.py PROFILE LIBRARY [PROGRAM...]

Programs count what they have of the header's inline functions. Reads what llvm-cov exports. A
line, or a condition's outcome, is reached if any of the copies that the file is compiled into
reaches it; what the compiler knows to be constant is no condition."""
import collections
import json
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def exported(profile, library, *programs):
    command = ["llvm-cov", "export", "-instr-profile", profile, library]
    for program in programs:
        command += ["-object", program]
    command += [ROOT + "/src", ROOT + "/include"]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)


def outcomes_of(data):
    """{(file, line, column, line, column, outcome): count}, the copies of a file added up."""
    counts = collections.Counter()
    for function in data["functions"]:
        for branch in function["branches"]:
            path = function["filenames"][branch[6]]
            for outcome, count in (("taken", branch[4]), ("not taken", branch[5])):
                counts[(path, *branch[:4], outcome)] += count
    return counts


def lines_of(data):
    """{(file, line): count}, the copies of a file added up. A line counts as often as the region
    that begins on it and counts most, else as the innermost region around it."""
    counts = collections.Counter()
    for function in data["functions"]:
        own, begun = {}, {}
        regions = [r for r in function["regions"] if r[7] == 0]
        for begin, _, end, _, count, file, *_ in sorted(regions, key=lambda r: (r[0], r[1], -r[2])):
            path = function["filenames"][file]
            for line in range(begin + 1, end + 1):
                own[path, line] = count
            begun[path, begin] = max(count, begun.get((path, begin), own.get((path, begin), 0)))
        own.update(begun)
        for line, count in own.items():
            counts[line] += count
    return counts


def source(path, cache={}):
    if path not in cache:
        with open(path) as file:
            cache[path] = file.read().split("\n")
    return cache[path]


def is_code(path, line):
    text = source(path)[line - 1].strip().strip("{}")
    return bool(text) and not text.startswith("#")


def main():
    data = exported(*sys.argv[1:])["data"][0]
    ours = lambda key: os.path.relpath(key[0], ROOT).split(os.sep)[0] in ("src", "include")
    lines = {k: n for k, n in lines_of(data).items() if ours(k) and is_code(*k)}
    outcomes = {k: n for k, n in outcomes_of(data).items() if ours(k)}
    for key in sorted(k for k, n in lines.items() if not n):
        print("%s:%d not reached: %s" % (os.path.relpath(key[0], ROOT), key[1],
                                         source(key[0])[key[1] - 1].strip()))
    for key in sorted(k for k, n in outcomes.items() if not n and lines.get((k[0], k[1]), 1)):
        path, line, first, last_line, last, outcome = key
        text = source(path)[line - 1][first - 1:last - 1 if last_line == line else None]
        print("%s:%d never %s: %s" % (os.path.relpath(path, ROOT), line, outcome, text))
    for name, counts in (("lines", lines), ("branches", outcomes)):
        reached = sum(n > 0 for n in counts.values())
        print("%s: %d of %d, %.1f %%" % (name, reached, len(counts), 100 * reached / len(counts)))


if __name__ == "__main__":
    main()
