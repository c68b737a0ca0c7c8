# SPDX-License-Identifier: MIT
"""The library beside its arithmetic limit: times, then which share of the library's the limit is."""
import statistics
from __main__ import Table

WORKS = ("matrices", "gradient", "fused")
STAGES = {"sums": "limit: sums alone", "results": "limit: reduced, inverted, formed"}
limits = []


def keep(report):
    """The faster arrangement of each set is its limit."""
    limits.extend(row for row in report.table_now.keyed() if row["is_limit"])


def shares(report):
    rows = report.table_now.keyed()
    times = Table(heads=[(head, None) for head in ("",) + WORKS])
    percents = Table(heads=[(head, "%.0f") for head in ("",) + WORKS])
    for stage, ending in (("library", ""), ("library+weights", " +weights")):
        times.rows.append([f"library, {report.context['isa']}{ending}"] +
                          [row[""] for row in rows if row["stage"] == stage])
    library = [statistics.median(row[""].wall) for row in rows if row["stage"] == "library"]
    for stage, title in STAGES.items():
        times.sections[len(times.rows)] = title
        percents.sections[len(percents.rows)] = f"share of the limit, {stage} [%]"
        for name in dict.fromkeys(row["set"] for row in limits):
            of_set = [row[""] for row in limits if (row["set"], row["stage"]) == (name, stage)]
            times.rows.append([name] + of_set)
            percents.rows.append([name] + [100 * statistics.median(time.wall) / whole
                                           for time, whole in zip(of_set, library)])
    times.print()
    percents.print()
