#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scene_figures.py ROOT EXAMPLES [--brief] [SCENE[:METHOD...]... [-- SEED...]]: the tables of docs/applications.md
beside what the scenes print for these seeds (4, 5, 6): all that a row says of a method must hold for every seed.
--brief: the rows that are measured before a scene is simulated. Without scenes: all of them, which takes
half an hour of processor time.
Figures of rounding depend on the instruction set, too: they may be ten times what stands there."""
import json
import os
import re
import subprocess
import sys

METHODS = ["sph", "kgc", "mls", "rkpm"]
ROUNDING = 1e-6  # and a figure below is one of rounding
EXACT = "range"  # of a scene's rows: a figure that must lie in the range, whatever its size
# What rows say, by the words that they begin with.
ROWS = {
    "normals": {
        "plane, mean": "plane_mean_degrees",
        "plane, worst": "plane_max_degrees",
        "plane under fluid": "beside_fluid_max_degrees",
        "the same, one matrix": "shared_matrix_max_degrees",
        "sphere of 12 r": "sphere_mean_degrees",
        "sphere, worst": "sphere_max_degrees",
    },
    "grid": {
        "largest deviation": "in_plane_deviation",
        "error of the slide": "slide_error",
        "particles through": "tunnelled",
        "at the start: error of the slope": "slope_error",
        "range of heights": "height_range_in_r",
    },
    "vorticity": {
        "worst error of the curl": "curl_error",
        "worst error of the spin": "spin_error",
        "Eq. (47)": "printed_curl_error",
        "angular momentum lost": "angular_momentum_lost",
    },
    "cube": {
        "viscous acceleration": "ghost_acceleration",
        "loss of kinetic energy": "energy_loss",
        "loss of angular momentum": "momentum_loss",
        "distance from the rigid shape": ("shape_rms", "shape_max"),
        "1 % noise": "noisy_momentum_loss",
        "the same: share of the noise": "noise_left",
        "power of a shear flow": "shear_error",
    },
    "top": {
        "angular momentum lost, implicit": "implicit_loss",
        "angular momentum lost, explicit": "explicit_loss",
        "stretched by 1 %": "stretch_error",
        "rigid rotation: error of R": "rotation_error",
        "rigid rotation: acceleration": "ghost_acceleration",
        "implicit operator": "implicit_ghost",
        "largest change of angular momentum": "ground_spin_change",
        "speed to the side": "ground_drift",
        "tilt of the axis": "ground_tilt",
    },
    "droplet": {
        "variation of the extent": "variation",
        "smallest over largest extent": "least_over_most",
        "speed of the centre": "drift",
        "the same with Eq. (45)": "printed_drift",
        "rms speed": "motion",
        "kappa = 50 N: variation": "control_variation",
        "inward pull": "pull",
    },
    "buckling": {
        "amplitude [m]": "amplitude",
        "reversals": "reversals",
        "top of the sheet": "top_late",
        "power of a shear flow": "shear_error",
    },
    "dam_break": {
        "gradients off by 10 %": "gradient_bad_share",
        "mean error of a gradient": "gradient_mean_error",
        "worst of those that can": "gradient_worst_error",
        "at the start: error of the wall's slope": "slope_error",
        "at the start: error of the power": "shear_error",
        "front at 1.2 m": "arrival",
        "particles outside": "outside",
    },
    "washing_machine": {
        "particles that escaped": "escaped",
        "largest mean compression": "mean_compression",
        "fastest particle": "fastest",
        "at the start: error of the work": "stretch_error",
        "at the start: error of the power": "shear_error",
        "smallest det F": "least_volume_of_body",
        "iterations": ("iterations_soap", "iterations_water", "iterations_body", "iterations_rate", "iterations_density"),
    },
}
failures = compared = 0


def complain(text):
    global failures
    failures += 1
    print(text, file=sys.stderr)


def step_of(text):
    """Of the last digit that stands there."""
    mantissa, _, exponent = text.partition("e")
    scale = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    if not exponent and "." not in mantissa and float(mantissa) >= 100:
        scale *= 10.0 ** (len(mantissa) - len(mantissa.rstrip("0")))  # 4200: two digits
    return scale


def agrees(cell, value):
    """'a to b [%]': all that rounds to a number between."""
    percent = cell.endswith("%")
    ends = cell.rstrip(" %").split(" to ")
    low, high = ends[0], ends[-1]
    value = abs(value) * (100 if percent else 1)
    if float(high) < ROUNDING and value <= 10 * float(high):
        return True
    slack = 0.5 + 1e-6
    return (float(low) - slack * step_of(low) <= value * (1 + 1e-5) and
            value * (1 - 1e-5) <= float(high) + slack * step_of(high))


def tables(text):
    for block in re.findall(r"(?:^\|.*\|\n)+", text, re.M):
        lines = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in block.splitlines()]
        yield [line for line in lines if "---" not in line[0]]


def rows_of(document, scene):
    """(words, method, cell) of the scene's section."""
    section = next(part for part in document.split("\n## ") if f"`examples/scenes/{scene}.c`" in part)
    for table in tables(section):
        heads = [head.lower() for head in table[0][1:]]
        if not heads or heads[0] != "sph":
            continue
        for row in table[1:]:
            for head, cell in zip(heads, row[1:], strict=True):
                for method in head.split(", "):
                    yield row[0], method, cell


def measured(folder, scene, method, seed, brief):
    words = [os.path.join(folder, scene), "--method", method, "--alone", "--seed", seed]
    printed = subprocess.run(words + ["--brief"] * brief, check=True, stdout=subprocess.PIPE, text=True).stdout
    return next(json.loads(line) for line in printed.splitlines() if line.startswith("{"))


def in_unit(words, value):
    return 1000 * value if "[mm/s]" in words else value


def check(document, scene, method, seed, found):
    global compared
    seen = set()
    for words, column, cell in rows_of(document, scene):
        begin = next((begin for begin in ROWS[scene] if words.startswith(begin)), None)
        if begin is None or column != method:
            continue
        seen.add(begin)
        keys = ROWS[scene][begin]
        keys = keys if isinstance(keys, tuple) else (keys,)
        cells = [cell] if len(keys) == 1 else re.split(" / |, ", cell)
        if cell in ("", "none") or any(key not in found for key in keys):
            continue
        for key, one in zip(keys, cells, strict=True):
            compared += 1
            if found[key] is None or not agrees(one, in_unit(words, found[key])):
                complain(f"docs/applications.md, {words}, {method}, seed {seed}: '{one}', but measured {found[key]:.6g}")
    for begin in ROWS[scene]:
        if begin not in seen:
            complain(f"docs/applications.md has no row '{begin}' of {scene} for {method}")


def main():
    words = sys.argv[3:]
    brief = "--brief" in words
    words = [word for word in words if word != "--brief"]
    at = words.index("--") if "--" in words else len(words)
    scenes, seeds = words[:at] or list(ROWS), words[at + 1:] or ["4", "5", "6"]
    with open(os.path.join(sys.argv[1], "docs", "applications.md"), encoding="utf-8") as file:
        document = file.read()
    for word in scenes:
        scene, *methods = word.split(":")
        columns = {column for _, column, _ in rows_of(document, scene)}
        for method in methods or [method for method in METHODS if method in columns]:
            for seed in seeds:
                check(document, scene, method, seed, measured(sys.argv[2], scene, method, seed, brief))
    print(f"{compared} figures compared, {failures} do not agree")
    return 1 if failures or not compared else 0


if __name__ == "__main__":
    sys.exit(main())
