# SPDX-License-Identifier: MIT
"""What more threads bring."""
import statistics
from __main__ import Table

WORKS = ("search", "matrices", "gradient", "fused")


def speed_ups(report):
    """Beside the first of the cases with more and more threads."""
    rows = [row for row in report.table_now.keyed() if row["group"] == "threads"]
    table = Table(heads=[(head, None) for head in ("threads",) + WORKS + ("speed-up, efficiency",)])
    for row in rows:
        ratios = [statistics.median(rows[0][work].wall) / statistics.median(row[work].wall) for work in WORKS]
        table.rows.append([row["label"], *(f"{ratio:.2f}, {100 * ratio / row['case_threads']:.0f} %"
                                           for ratio in ratios), ""])
    table.print()
