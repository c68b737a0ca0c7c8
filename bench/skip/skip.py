# SPDX-License-Identifier: MIT
from report import show, where


def report_of(report):
    rows, c = report.rows("skip"), report.context
    report.print_lattice(f"2D: {c['.plane_pairs']:.2f}\nscheme     KGC, cubic spline, f32; neighbours kept and found before, "
                         "unless it says search")
    print(f"times      median (min-max) of {c['.repetitions']} rounds [ms]; exact: compared with the full result")
    report.print_if_busy(rows[0]["full"])
    for row in rows:
        row["saved_percent"] = 100 * (1 - row["this"].median() / row["full"].median())
        row[".exact"] = "-" if not row["compared"] else "same bits" if row["targets_with_other_bits"] == 0 else \
            f"off by {row['deviation']:.1e}"
    show(rows, (("what", "what"), ("against", ".against"), ("full [ms]", "full"), ("this [ms]", "this"),
                ("saved %", "saved_percent", "%.0f"), ("exact", ".exact")),
         dict.fromkeys(where(rows, lambda row: row["group"])[1:]))
    if c["skin_was_spent"]:
        print("\nThe skin did not hold: its row includes searches that found pairs anew.")
