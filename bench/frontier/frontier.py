# SPDX-License-Identifier: MIT
"""Who is on a frontier: nothing of its side is as fast and as accurate. Ways that search for themselves and ways
over lists of the host, who searched, do not compete."""
import statistics
from __main__ import Table

METHODS, PRECISIONS = ("KGC", "MLS", "RKPM", "CMLS", "CRKPM", "SPH"), ("f32", "f64", "mixed")
# Of a field: its error, and what counts as smaller. The linear one's is all rounding, the same within a factor of 2.
FIELDS = {"trigonometric": ("trigonometric_mean", 0.97), "linear": ("linear_max", 0.5)}
SIDES = (False, True)  # the host's lists


def find(rows, error, smaller, host):
    """From the fastest on, those with a smaller error than all before."""
    least, found = float("inf"), []
    for number, row in enumerate(rows):
        if (row["path"] == "host's lists") == host and row[error] < smaller * least:
            least = row[error]
            found.append(number)
    return found


def frontiers(report):
    """Puts the rows in the order of their times, the fastest first, marks who is on a frontier, and prints these."""
    table = report.table_now
    table.rows.sort(key=lambda row: statistics.median(row[5].wall))
    rows = table.keyed()

    def show(title, numbers):
        shown = Table("frontier")
        shown.columns, shown.rows = table.columns, [table.rows[number] for number in numbers]
        print("\n" + title)
        shown.print()

    show("fastest way of each method and precision, whatever its error",
         [next(number for number, row in enumerate(rows) if
               (row["method"], row["precision"], row["path"] == "host's lists") == (method, precision, host))
          for method in METHODS for precision in PRECISIONS for host in SIDES])
    found = {(field, host): find(rows, *FIELDS[field], host) for field in FIELDS for host in SIDES}
    show("frontier: nothing is faster and, on average, nearer to the trigonometric field", found["trigonometric", False])
    show("frontier: nothing is faster and, at worst, nearer to the linear field", found["linear", False])
    show("the first frontier of those who search for themselves", found["trigonometric", True])
    show("and the second", found["linear", True])
    for field in FIELDS:
        table.columns.append([None, field + "_frontier", None, None])
        for number, row in enumerate(table.rows):
            row.append(int(number in found[field, False] + found[field, True]))
