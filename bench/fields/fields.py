# SPDX-License-Identifier: MIT
import math
from report import show

LATTICES = {"square": "", "jittered": "_jittered"}
FIELDS = ("rotation", "trigonometric")
ERRORS = (("boundary max", "boundary_max", "%.3e"), ("mean", "boundary_mean", "%.3e"), ("inside max", "inside_max", "%.3e"),
          ("mean", "inside_mean", "%.3e"), ("curl max", "curl_max", "%.3e"))
# Pictures: a name, what draws it, the field, and which of its errors.
PICTURES = (("fields_rotation", "fig2_trigonometric_draw", "rotation", "gradient"),
            ("fields_trigonometric", "fig2_trigonometric_draw", "trigonometric", "gradient"),
            ("fields_curl", "fig2_trigonometric_draw", "rotation", "curl"),
            ("fields_convergence", "fig2_trigonometric_convergence_draw", "trigonometric", ""),
            ("fields_order", "trigonometric_order_draw", "trigonometric", ""))


def report_of(report):
    if ".input" in report.context:
        show_waves(report, report.rows("waves"))
        return
    c, rows = report.context, report.rows("errors")
    print("Velocity gradients on [-1, 1]^2, Figs. 2 and 4 of doi:10.1145/3606933\n"
          f"difference form, {c['.kernel_title']}, H = {c['.support']:g} d, d = 2 / N, {c['.precision']}, V_j = 1 / sum_k W_jk "
          "(j included)\nboundary: the two outermost layers")
    for lattice in LATTICES:
        show_lattice(c, lattice, [row for row in rows if row["lattice"] == lattice])
    for name, table in report.tables:
        if name.endswith(".csv"):
            report.write_csv(table, name)
    report.write_csv(rows, "fields_convergence.csv")
    for lattice, ending in LATTICES.items():
        for name, script, field, quantity in PICTURES:
            report.draw(f"{name}{ending}.gp", ["fields/draw_common.gp", f"fields/{script}.gp"],
                        output=f"{name}{ending}.png", field=field, formula=c["." + field], lattice=lattice,
                        support=f"{c['.support']:g}", kernel=c[".kernel_title"], precision=c[".precision"],
                        side=c[".side"], quantity=quantity)
    report.print_written("fields_*.csv, fields_*.gp", ", fields_*.png")


def show_lattice(c, lattice, rows):
    side = c[".side"]
    moved = f", each coordinate moved by up to {c['.jitter']:g} d" if lattice == "jittered" else ""
    print(f"\n{lattice} lattice{moved}: N = {side}, {side**2} particles, {side**2 - (side - 4)**2} of them on the boundary; "
          "error |J_i - J|_F")
    smallest = [row for row in rows if row["N"] == side]
    show(smallest, (("", "method"), *ERRORS),
         {next(n for n, row in enumerate(smallest) if row["field"] == field): c["." + field] for field in FIELDS})
    # The error falls as d^order between the two finest lattices.
    columns, table = [("convergence, trigonometric, max", "method")], []
    for half in ("boundary", "inside"):
        columns += [(f"{half} N = {side}", half + "0", "%.3e"), (str(2 * side), half + "1", "%.3e"),
                    (str(4 * side), half + "2", "%.3e"), ("order", half, "%.2f")]
    for method in dict.fromkeys(row["method"] for row in rows):
        found = {"method": method}
        for half in ("boundary", "inside"):
            errors = [row[half + "_max"] for row in rows if (row["field"], row["method"]) == ("trigonometric", method)]
            found |= {f"{half}{size}": error for size, error in enumerate(errors)}
            found[half] = math.log2(errors[1] / errors[2])
        table.append(found)
    show(table, columns)


def show_waves(report, rows):
    c, groups = report.context, ("curvature", "slopes", "neither")
    shares = [100 * rows[0]["." + group] / c[".particles"] for group in groups]
    print(f"particles  {c['.particles']} of {c['.input']}, {c['.dimension']}D, H = {c['.support']:g}, volume {c['.volume']}\n"
          f"resolved   slopes and curvature by {shares[0]:.2f} %, slopes alone by {shares[1]:.2f} %, neither by "
          f"{shares[2]:.2f} %\nerrors     |J_i - J|_F / k of v_a = sin(k x_a) cos(k x_b), 10 H a wave")
    show(rows, [("", "method")] + [column for group in groups for column in (
        (f"{group}: mean", group + "_mean", "%.3e"), ("max", group + "_max", "%.3e"))])
    report.write_csv(rows, "fields_input.csv")
    report.print_written("fields_input.csv")
