# SPDX-License-Identifier: MIT
from report import show

PER_PAIR = "%.3f (%.3f-%.3f)"


def report_of(report):
    sums, pairs, c = report.rows("lists/sums"), report.rows("lists/pairs"), report.context
    report.print_lattice(f"KGC, cubic spline, {c['.precision']}")
    print(f"times      ns a pair, median (min-max) of {c['.repetitions']} rounds through everything; gradient and pairs "
          "written out:\n           with matrices that are there; error: largest |J_i - J|_F / |J|_F of v = (-y, x, 2z)")
    report.print_if_busy(sums[0]["fused"])
    show(sums, (("sums over", "supply"), *((work, work, PER_PAIR) for work in ("build", "matrices", "gradient", "fused")),
                ("error", "error_max", "%.1e")))
    show(pairs, (("pairs written out", "what"), ("time", "", PER_PAIR), ("error", "error_max", "%.1e")))
