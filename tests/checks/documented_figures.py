#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""documented_figures.py ROOT SPHGRAD_BENCH TEST_HOSTILE_ARGUMENTS PUBLIC_NAMES EXAMPLE [SEED...]: figures of the
documents beside what their commands print today: the tables of docs/stability.md, the counts of
docs/reliability.md, the errors in the README, the angles of normals in docs/applications.md.
"a to b" is a range, and each number stands for all that round to it. The commands that take minutes are left
out."""
import csv
import json
import os
import re
import subprocess
import sys
import tempfile

METHODS = ["KGC", "MLS", "RKPM", "CMLS", "CRKPM"]
LONG = {"neighbours"}  # minutes
DROPPED = {"crowds"}  # a sentence, no table
failures = 0


def complain(text):
    global failures
    failures += 1
    print(text, file=sys.stderr)


def half_of_last_digit(text):
    mantissa, _, exponent = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    scale = 10.0 ** (int(exponent or 0) - decimals)
    if not exponent and not decimals and float(mantissa) >= 10 and mantissa.endswith("0"):
        scale = 10.0 ** (len(mantissa) - len(mantissa.rstrip("0")))  # 1600: two digits
    return 0.5 * scale


def agrees(cell, value, percent):
    ends = cell.split(" to ")
    if percent and cell in ("0", "100"):
        return value == float(cell)
    slack = 1e-9 + 1e-3 * (not percent)  # the CSV has four digits
    low, high = ends[0], ends[-1]
    return (float(low) - half_of_last_digit(low) * (1 + slack) <= value
            <= float(high) + half_of_last_digit(high) * (1 + slack))


def tables(text):
    """Each table as a list of rows of cells, the head first."""
    for block in re.findall(r"(?:^\|.*\|\n)+", text, re.M):
        lines = [line.strip().strip("|").split("|") for line in block.splitlines()]
        yield [[cell.strip() for cell in line] for line in lines if "---" not in line[0]]


def run(program, sweep, repetitions, seed, folder):
    """Without the reference and the other policies, which take most of the time and have none of the figures."""
    subprocess.run([program, "stability", "--sweep", sweep, "--repetitions", repetitions, "--compare", "0",
                    "--policy", "blend", "--seed", seed, "--threads", "2", "--output", folder], check=True, stdout=subprocess.DEVNULL)
    with open(os.path.join(folder, "stability.csv"), encoding="utf-8") as file:
        next(file)
        return [row for row in csv.DictReader(file) if row["policy"] == "blend"]


def find(rows, method, precision, place):
    for row in rows:
        at = float(row["at"])
        if row["method"] == method and row["precision"] == precision and abs(at - place) <= 1e-6 * place:
            return row
    raise SystemExit(f"no {method} {precision} at {place}")


def compare(what, cell, value, percent=True):
    if not agrees(cell, value, percent):
        complain(f"docs/stability.md, {what}: '{cell}', but measured {value:.5g}")


def check_threshold(table, rows):
    columns = [("full", "f32"), ("linear_mean", "f32"), ("noise", "f32"), ("linear_full", "f32"),
               ("linear_full", "f64"), ("decomposed", "f32")]
    for row in table[1:]:
        for (name, precision), cell in zip(columns, row[1:], strict=True):
            percent = name in ("full", "decomposed")
            value = float(find(rows, "KGC", precision, float(row[0]))[name])
            compare(f"eps {row[0]}, {name} {precision}", cell, 100 * value if percent else value, percent)
    return len(table) - 1


def check_ranks(table, sweep, rows):
    checked = 0
    for row in table[1:]:
        if row[0] != sweep:
            continue
        for method, cell in zip(METHODS, row[2:], strict=True):
            compare(f"{sweep} {row[1]}, {method}", cell,
                    100 * float(find(rows, method, "f32", float(row[1]))["full"]))
        checked += 1
    return checked


def check_normals(root, folder, seed):
    """Angles of a scene that takes half a second."""
    scene = os.path.join(folder, "scenes", "normals")
    if not os.path.exists(scene):
        return
    printed = subprocess.run([scene, "--seed", seed], check=True, stdout=subprocess.PIPE, text=True).stdout
    found = {line["method"]: line for line in map(json.loads, re.findall(r"^{.*}$", printed, re.M))}
    rows = next(t for t in tables(read(root, "docs", "applications.md")) if "[degrees]" in t[0][0])
    keys = {"plane, mean": "plane_mean_degrees", "plane, worst": "plane_max_degrees",
            "sphere of 12 r, mean": "sphere_mean_degrees", "sphere, worst": "sphere_max_degrees"}
    checked = [row for row in rows if row[0] in keys]
    for row in checked:
        for cell, method in zip(row[1:3], ("sph", "kgc"), strict=True):
            value = found[method][keys[row[0]]]
            if not agrees(cell, value, False):
                complain(f"docs/applications.md, {row[0]}, {method}, seed {seed}: '{cell}', but measured {value:.5g}")
    if len(checked) != len(keys):
        complain("docs/applications.md has other rows of normals")


def check_kernels(table, program):
    """The worst of a few cases is no worse than what stands there of all."""
    for row in table[1:]:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([program, "stability", "--quick", "--sweep", "jitter", "--repetitions", "4",
                            "--compare", "8", "--kernel", row[0], "--threads", "2", "--output", folder],
                           check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, "stability.csv"), encoding="utf-8") as file:
                next(file)
                cases = list(csv.DictReader(file))
        for cell, column, methods in ((row[1], "ratio_full", METHODS[:3]), (row[2], "ratio_full", ["SPH"]),
                                      (row[3], "ratio_touched", METHODS)):
            worst = max(float(case[column]) for case in cases if case["method"] in methods)
            most = cell.split(" to ")[-1]
            if not 0 < worst <= float(most) + half_of_last_digit(most):
                complain(f"docs/stability.md, {row[0]}, {column}: '{cell}', but measured {worst:.5g}")
    if len(table) != 8:
        complain("docs/stability.md does not speak of seven kernels")


def read(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return file.read()


def check_counts(root, hostile, names):
    """Of hostile calls, functions and members, which grow with the interface."""
    document = read(root, "docs", "reliability.md")
    every_case = {name: value for name, value in os.environ.items() if name != "SPHG_TEST_SHARE"}
    output = subprocess.run([hostile], check=True, stdout=subprocess.PIPE, text=True, env=every_case).stdout
    counts = {"every_bad": 0, "trusted": 0}
    name = ""
    for line in output.splitlines():
        name = line.split("]")[1].strip() if "RUN" in line else name
        for begin in counts:
            if line.endswith(" cells") and name.startswith(begin):
                counts[begin] += int(line.split()[0])
    public = read(names).split("#define")
    functions, members = (len(re.findall(r"\bX\(\w+,", part)) for part in public[1:3])
    for count, words in ((counts["every_bad"], "calls: "), (counts["trusted"], "calls |"),
                         (functions, "functions, "), (functions, "names, "), (members, "members |")):
        figure = f"{count:,}".replace(",", " ")
        if f" {figure} {words}" not in document:
            complain(f"docs/reliability.md does not say '{figure} {words}', which is what there is")


def check_readme(root, program, example):
    """The error of plain SPH on the rotating square, and what the example prints."""
    document = read(root, "README.md")
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "fields", "--output", folder], check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(folder, "fields_rotation_square.csv"), encoding="utf-8", newline="") as file:
            next(file)
            worst = max(float(row["gradient_error_SPH"]) for row in csv.DictReader(file))
    said = re.search(r"off by up to ([\d.]+) at the border", document)
    if not said or f"{worst:.2f}" != said.group(1):
        complain(f"README.md: plain SPH is off by {worst:.2f} at the border of the rotating square")
    printed = subprocess.run([example], check=True, stdout=subprocess.PIPE, text=True).stdout
    if f"It prints `{printed.strip()}`." not in document:
        complain(f"README.md: its example prints {printed.strip()}")


def main():
    root, program, hostile, names, example = sys.argv[1:6]
    seeds = sys.argv[6:] or ["0"]
    text = read(root, "docs", "stability.md")
    check_counts(root, hostile, names)
    check_readme(root, program, example)
    by_head = {table[0][0]: table for table in tables(text)}
    for seed in ("2", "6"):
        check_normals(root, os.path.dirname(example), seed)
    check_kernels(by_head["kernel"], program)
    commands = re.findall(r"--sweep (\w+) --repetitions (\d+) --compare 1", text)
    sweeps = [(sweep, count) for sweep, count in commands if sweep not in LONG | DROPPED]
    if sorted(sweep for sweep, _ in sweeps) != ["jitter", "slab", "threshold", "volumes"]:
        complain(f"commands in docs/stability.md: {commands}")
    for seed in seeds:
        for sweep, count in sweeps:
            with tempfile.TemporaryDirectory() as folder:
                rows = run(program, sweep, count, seed, folder)
            checked = (check_threshold(by_head["eps"], rows) if sweep == "threshold"
                       else check_ranks(by_head["sweep"], sweep, rows))
            if checked == 0:
                complain(f"docs/stability.md has no figures of {sweep}")
    return 1 if failures else 0


sys.exit(main())
