# SPDX-License-Identifier: MIT
from report import grouped, plural, show, where

WORKS = ("search", "matrices", "gradient", "fused")


def report_of(report):
    rows, c = report.rows("scaling"), report.context
    print(f"particles  {grouped(c['.particles'])}, lattice jittered by {c['.jitter']:g} spacings, H = {c['.support']:g} "
          "spacings, lattice order, but for what a\n           group changes; KGC, cubic spline, f32")
    report.print_machine()
    print(f"times      ns a particle, median (min-max) of {c['.repetitions']} rounds through the cases of a group; fused:\n"
          "           matrices and gradient in one call; bytes: a particle, held by the neighbours\n"
          "errors     largest |J_i - J|_F / |J|_F of v = (-y, x, 2z), in 2D (-y, x), where rank is full")
    report.print_if_busy(rows[0]["fused"])
    for row in rows:
        row[".deficient"] = 100 * row["deficient_share"]
    show(rows, (("", "label"), ("pairs", "pairs_per_particle", "%.1f"), ("bytes", "bytes_per_particle", "%.0f"),
                *((work + " [ns]", work, "%.1f (%.0f-%.0f)") for work in WORKS), ("deficient %", ".deficient", "%.1f"),
                ("error", "error_max", "%.1e")),
         {number: rows[number]["group"] for number in where(rows, lambda row: row["group"])})
    show_speed_ups([row for row in rows if row["group"] == "threads"])
    for row in rows:
        if row["not_finite"] > 0:
            print(f"\nNOT FINITE: {row['not_finite']} numbers of {row['group']}, {row['label']}")
    report.write_csv(rows, "scaling.csv")
    report.draw("scaling.gp", ["scaling/scaling.gp"], threads=c["threads"],
                title=f"{c['.particles']} particles, H = {c['.support']:g} spacings, {plural(c['threads'], 'thread')}, "
                      f"{c['cpu_model']}, but for what a panel changes")
    report.print_written("scaling.csv, scaling.gp", ", scaling.png")


def show_speed_ups(rows):
    """Beside the first of the cases with more and more threads."""
    table = []
    for row in rows:
        ratios = {work: rows[0][work].median() / row[work].median() for work in WORKS}
        table.append({"threads": row["label"], "": ""} | {
            work: f"{ratio:.2f}, {100 * ratio / row['case_threads']:.0f} %" for work, ratio in ratios.items()})
    show(table, (("threads", "threads"), *((work, work) for work in WORKS), ("speed-up, efficiency", "")))
