# SPDX-License-Identifier: MIT
from report import show


def report_of(report):
    rows, c = report.rows("forces"), report.context
    report.print_lattice(f"cubic spline, {c['.precision']}")
    print(f"times      ms, median (min-max) of {c['.repetitions']} rounds; corrections are there\n"
          "error      adjoint and symmetric: |sum f| / sum |f|, which conservation makes 0; difference: largest\n"
          "           relative error of div (-y, x, 2z)")
    report.print_if_busy(rows[0]["lists"])
    show(rows, (("operator", "operator"), ("method", "method"), ("kept lists", "lists"),
                ("kept weights", "lists and weights"), ("error", "error", "%.1e")))
