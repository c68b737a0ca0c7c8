# SPDX-License-Identifier: MIT
"""Tables of the errors on the lattices."""
import math
from __main__ import Table

ERRORS = (("boundary max", "boundary_max"), ("mean", "boundary_mean"), ("inside max", "inside_max"),
          ("mean", "inside_mean"), ("curl max", "curl_max"))


def lattices(report, jitter, *formulas):
    rows = report.table_now.keyed()
    for lattice in ("square", "jittered"):
        here = [row for row in rows if row["lattice"] == lattice]
        sides = sorted({row["N"] for row in here})
        moved = f", each coordinate moved by up to {jitter} d" if lattice == "jittered" else ""
        print(f"\n{lattice} lattice{moved}: N = {sides[0]}, {sides[0]**2} particles, "
              f"{sides[0]**2 - (sides[0] - 4)**2} of them on the boundary; error |J_i - J|_F")
        errors_of([row for row in here if row["N"] == sides[0]], formulas).print()
        convergence_of([row for row in here if row["field"] == "trigonometric"], sides).print()


def errors_of(rows, formulas):
    table = Table(heads=[("", None)] + [(head, "%.3e") for head, _ in ERRORS])
    for field, formula in zip(("rotation", "trigonometric"), formulas):
        table.sections[len(table.rows)] = formula
        table.rows += [[row["method"]] + [row[key] for _, key in ERRORS] for row in rows if row["field"] == field]
    return table


def convergence_of(rows, sides):
    """The error falls as d^order between the two finest lattices."""
    heads = [("convergence, trigonometric, max", None)]
    for half in ("boundary", "inside"):
        heads += [(f"{half} N = {sides[0]}", "%.3e"), *((str(side), "%.3e") for side in sides[1:]), ("order", "%.2f")]
    table = Table(heads=heads)
    for method in dict.fromkeys(row["method"] for row in rows):
        cells = [method]
        for half in ("boundary_max", "inside_max"):
            errors = [row[half] for row in rows if row["method"] == method]
            cells += errors + [math.log2(errors[1] / errors[2])]
        table.rows.append(cells)
    return table
