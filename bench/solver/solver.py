# SPDX-License-Identifier: MIT
from report import Time, grouped, show, where


def report_of(report):
    rows, c = report.rows("solver"), report.context
    print("matrices   3 x 3 and 2 x 2, items packed, so many in a batch; memcpy: their numbers moved from the input\n"
          "           to the results, no arithmetic; fell: share that the call sent to the decomposition")
    report.print_machine()
    print(f"times      ns a matrix, median (min-max) of {c['.repetitions']} rounds through the cases and instruction sets of a "
          "group;\n           off by: C M - 1 of the certified, else what the factors miss of A, the largest entry over "
          "that of A")
    timed = [name for name in rows[0] if any(isinstance(row[name], Time) for row in rows)]
    groups = where(rows, lambda row: (row["dimension"], row["precision"], row["matrices"]))
    show(rows, (("", "work"), ("", "what"), *((name, name, "%.2f (%.2f-%.2f)") for name in timed),
                ("fell %", "decomposed_percent", "%.2f"), ("off by", "deviation", "%.1e")),
         {n: f"{rows[n]['dimension']}, {rows[n]['precision']}, {grouped(int(rows[n]['matrices']))}" for n in groups})
