# SPDX-License-Identifier: MIT
from report import show

WORKS = ("matrices", "gradient", "fused")
STAGES = {"sums": "limit: sums alone", "results": "limit: reduced, inverted, formed"}


def report_of(report):
    probe, c = report.rows("probe"), report.context
    limits = [rows for name, rows in report.tables if name == "limit"]
    report.print_lattice("KGC, cubic spline, f32")
    sets = list(dict.fromkeys(row["set"] for row in limits[0])) if limits else []
    for number, name in enumerate(sets):
        of_set = [row for row in limits[0] if row["set"] == name]
        print(f"{'' if number else 'packed':11}{name}: {of_set[0]['.pairs']:.1f} pairs in {of_set[0]['vectors']:.0f} vectors a "
              f"target, {of_set[0]['.kB']:.0f} kB, off double by {max(row['deviation'] for row in of_set):.1e}")
    print("probe      int32 CSR, sorted 16-byte rows; error of its Jacobians, and what its matrices are off the library's\n"
          f"times      median (min-max) of {c['.repetitions']} rounds, ms for all targets")
    if limits:
        print("+weights   the sweep before kept what kernel and volume give each pair: no kernel, root or division, which the "
              "limits hold")
    report.print_if_busy(probe[1][""])
    show(probe, (("probe", "work"), ("time", ""), ("error", "error_max", "%.1e"), ("off by", "matrix_deviation", "%.1e")))
    if limits:
        compare(*limits)
        show_limits(c["isa"], sets, *limits)


def compare(packed, library):
    """Each arrangement beside the library; the faster one of a set counts."""
    whole = {row["work"]: row[""].median() for row in library if row["stage"] == "library"}
    for row in packed:
        rivals = [other[""].median() for other in packed if all(other[key] == row[key] for key in ("work", "stage", "set"))]
        row["percent_of_library"] = 100 * row[""].median() / whole[row["work"]]
        row["is_limit"] = int(row[""].median() == min(rivals))


def show_limits(isa, sets, packed, library):
    """Times, then which share of the library's the limit is, of each set that of its faster arrangement."""
    times, percents, time_titles, percent_titles = [], [], {}, {}
    for stage, ending in (("library", ""), ("library+weights", " +weights")):
        times.append({"": f"library, {isa}{ending}"} | {row["work"]: row[""] for row in library if row["stage"] == stage})
    for stage, title in STAGES.items():
        time_titles[len(times)], percent_titles[len(percents)] = title, f"share of the limit, {stage} [%]"
        for name in sets:
            limits = [row for row in packed if (row["set"], row["stage"]) == (name, stage) and row["is_limit"]]
            times.append({"": name} | {row["work"]: row[""] for row in limits})
            percents.append({"": name} | {row["work"]: row["percent_of_library"] for row in limits})
    show(times, (("", ""), *((work, work) for work in WORKS)), time_titles)
    show(percents, (("", ""), *((work, work, "%.0f") for work in WORKS)), percent_titles)
