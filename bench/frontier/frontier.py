# SPDX-License-Identifier: MIT
from report import grouped, plural, show

METHODS, PRECISIONS = ("KGC", "MLS", "RKPM", "CMLS", "CRKPM", "SPH"), ("f32", "f64", "mixed")
# Of a field: its error, and what counts as smaller. The linear one's is all rounding, the same within a factor of 2.
FIELDS = {"trigonometric": ("trigonometric_mean", 0.97), "linear": ("linear_max", 0.5)}
# Ways that search for themselves and ways over lists of the host, who searched, do not compete.
SIDES = (False, True)
COLUMNS = (("method", "method"), ("kernel", "kernel"), ("type", "precision"), ("path", "path"), ("option", "option"),
           ("ns", "", "%.1f (%.0f-%.0f)"), ("trig. mean", "trigonometric_mean", "%.2e"), ("max", "trigonometric_max", "%.1e"),
           ("lin. mean", "linear_mean", "%.1e"), ("max", "linear_max", "%.1e"))


def report_of(report):
    if report.tables[0][0] == "frontier":
        show_ways(report, report.rows("frontier"))
    else:
        report.print_machine()
    show_order(report, report.rows("order"))


def is_hosts(row):
    return row["path"] == "host's lists"


def find_frontier(rows, error, smaller):
    """From the fastest on, those with a smaller error than all before: nothing is as fast and as accurate."""
    found = []
    for row in rows:
        if not found or row[error] < smaller * found[-1][error]:
            found.append(row)
    return found


def show_ways(report, rows):
    c = report.context
    print(f"particles  {grouped(c['particles'])}, a block with free surfaces, jittered by {c['jitter']:g} spacings, "
          f"H = {c['support_spacings']:g} spacings, {c['pairs_per_particle']:.1f} pairs a particle")
    report.print_machine()
    print(f"times      ns a particle from positions to Jacobians, median (min-max) of {c['.repetitions']} rounds through "
          f"{len(rows)} ways;\n           host's lists: taken over, not searched for; kept weights: matrices form and keep "
          "them, the\n           gradient does without kernel, root and division\n"
          "errors     |J_i - J|_F over the root mean square of |J|_F, over all particles, of\n"
          "           v_a = sin(k x_a) cos(k x_b), 20 spacings a wave, and of v = (-y, x, 2z)")
    rows.sort(key=lambda row: row[""].median())
    report.print_if_busy(rows[0][""])
    print("\nfastest way of each method and precision, whatever its error")
    show([next(row for row in rows if (row["method"], row["precision"], is_hosts(row)) == (method, precision, host))
          for method in METHODS for precision in PRECISIONS for host in SIDES], COLUMNS)
    found = {(field, host): find_frontier([row for row in rows if is_hosts(row) == host], *FIELDS[field])
             for field in FIELDS for host in SIDES}
    for place, title in ((("trigonometric", False),
                          "frontier: nothing is faster and, on average, nearer to the trigonometric field"),
                         (("linear", False), "frontier: nothing is faster and, at worst, nearer to the linear field"),
                         (("trigonometric", True), "the first frontier of those who search for themselves"),
                         (("linear", True), "and the second")):
        print("\n" + title)
        show(found[place], COLUMNS)
    for row in rows:
        for field in FIELDS:
            row[field + "_frontier"] = int(any(row is other for host in SIDES for other in found[field, host]))
    report.write_csv(rows, "frontier.csv")
    report.draw("frontier.gp", ["frontier/frontier.gp"], title=f"{c['particles']} particles, H = {c['support_spacings']:g} "
                f"spacings, {plural(c['threads'], 'thread')}, {c['cpu_model']}")
    report.print_written("frontier.csv, frontier.gp", ", frontier.png")


def show_order(report, rows):
    c = report.context
    print("\norder 2 beside order 1: N^3 particles in [-1, 1]^3, v = (cos 2x, cos y - sin 3x, cos 2z), KGC (classic: CMLS), "
          "f32;\nerror |J_i - J|_F of the two outermost layers, and inside")
    show(rows, (("", "way"), ("H", "support"), ("N", "side"), ("ns", "", "%.0f (%.0f-%.0f)"), ("ms", "all", "%.2f (%.2f-%.2f)"),
                ("boundary max", "boundary_max", "%.2e"), ("mean", "boundary_mean", "%.2e"),
                ("inside max", "inside_max", "%.2e"), ("mean", "inside_mean", "%.2e")),
         dict.fromkeys(number for number, row in enumerate(rows) if number and row["way"] == rows[0]["way"]))
    report.write_csv(rows, "frontier_order.csv")
    report.draw("frontier_order.gp", ["frontier/frontier_order.gp"], title=f"order 2 beside order 1: jitter {c['.jitter']:g}, "
                f"{plural(c['threads'], 'thread')}, {c['cpu_model']}")
    report.print_written("frontier_order.csv, frontier_order.gp", ", frontier_order.png")
