# SPDX-License-Identifier: MIT
"""Table 1 as the paper has it, methods side by side, and what it was measured on."""
from report import Time, grouped, milliseconds, text_of

# Lines of the table: what they begin with, a cell of each method, its format. None: a blank line.
LINES = (("", "method"), ("T_mat   [ms]", "matrix"), ("T_grad  [ms]", "gradient"), ("fused   [ms]", "fused"),
         ("T_mat  +weights [ms]", "matrix+weights"), ("T_grad +weights [ms]", "gradient+weights"),
         ("fused  +weights [ms]", "fused+weights"), None, ("T_mat   [ns a pair]", ".matrix", "%.3f"),
         ("T_grad  [ns a pair]", ".gradient", "%.3f"), ("fused   [ns a pair]", ".fused", "%.3f"), None,
         ("error of T_grad", "gradient_error", "%.2e"), ("error of fused", "fused_error", "%.2e"), ("rank 0", ".rank0"),
         ("rank 1", ".rank1"), ("rank 2", ".rank2"), ("rank 3", ".rank3"), ("to the eigensolver", ".decomposed"), None,
         ("paper, T_mat  [ms]", "paper_matrix", "%.2f"), ("paper, T_grad [ms]", "paper_gradient", "%.2f"))


def report_of(report):
    c, rows = report.context, report.tables[-1][1]
    search, probe = report.rows("table1")[0]["search"], report.rows("probe")[0]
    pairs, dimension = round(c["pairs_per_particle"] * c["particles"]), c["dimension"]
    deficient = any(row[f".rank{dimension}"] != c["particles"] for row in rows if row["method"] != "SPH")
    print_set_up(report, pairs, search)
    print_probe(c, probe, rows[1])
    repetitions = len(search.wall)
    print(f"\nmedian of {repetitions} repetition{'s' * (repetitions > 1)} after a warm-up, methods in turn; search not "
          "included\n")
    show_turned([shown_of(row, c, pairs, deficient) for row in rows])
    print_suspect(c, rows[1])
    print_footer(c, rows, deficient)
    if c[".output"]:
        report.write_csv(rows, "table1.csv")
        report.draw("table1.gp", ["table1/table1.gp"], threads=c["threads"],
                    title=f"{grouped(c['particles'])} particles, {c['.kernel_title']}, H = {c['support_spacings']:g} spacings, "
                          f"search not included; {c['cpu_model']}, {c['isa']}, {c['precision']}")
        report.print_written("table1.csv, table1.gp", ", table1.png")


def is_given(c):
    return c["particles_from"] != "lattice"


def print_particles(c):
    if is_given(c):
        print(f"particles  {grouped(c['particles'])} of {c['particles_from']}{', ' if c['.flat'] else ''}{c['.flat']}")
        if c[".frames"]:
            print("           the first of several frames in the file")
        order = "shuffled" if c["order"] == "shuffled" else "file's"
        print(f"           columns {c['.columns']}\n           {order} order, volume {c['.volume']}, timed field: " +
              (f"{c['.velocities']} velocities" if c[".velocities"] else formula(c)))
        return
    nearest = f" (the cube nearest to {grouped(c['.particles'])})" if c["particles"] != c[".particles"] else ""
    moved = f"each coordinate moved by up to {c['jitter']:g} spacings, " if c["jitter"] > 0 else ""
    print(f"particles  {grouped(c['particles'])} in a lattice of {' x '.join(3 * [str(c['.side'])])}{nearest}, spacing 1/128\n"
          f"           {moved}{c['order']} order, volume {c['.volume']}")


def formula(c):
    return "v = (-y, x, 2z)" if c["dimension"] == 3 else "v = (-y, x)"


def print_set_up(report, pairs, search):
    c = report.context
    print("Table 1 of Westhofen, Jeske, Bender 2023, doi:10.1145/3606933\n")
    print_particles(c)
    print(f"scheme     {c['.kernel_title']}, H = {c['support_spacings']:g}{'' if is_given(c) else ' spacings'}, threshold 0.01 "
          f"(blend), {c['precision']}{': positions f64, the rest f32' if c['precision'] == 'mixed' else ''}")
    report.print_machine()
    each = f", {1e6 * search.median() / pairs:.3f} ns a pair" if pairs else ""
    print(f"pairs      {grouped(pairs)}, {c['pairs_per_particle']:.2f} a particle; {c['bytes_per_particle']:.1f} bytes a "
          f"particle held by the neighbours\nsearch     T_ns {text_of(search).replace(' (', ' ms (')}{each}; the first, with "
          f"allocation, {milliseconds(c['search_first_ms'])} ms")


def print_probe(c, probe, kgc):
    """And how much longer a particle takes here than with the probe."""
    times = [probe["matrices"].median(), probe["gradient"].median()]
    over = [kgc[work].median() / c["particles"] / (time / probe["particles"])
            for work, time in zip(("matrix", "gradient"), times)]
    print(f"yardstick  {milliseconds(times[0])} and {milliseconds(times[1])} ms for matrices and gradient of "
          f"{grouped(probe['particles'])} particles by `limit --probe`;\n           a particle's T_mat and T_grad of KGC take "
          f"{over[0]:.2f} and {over[1]:.2f} of its")


def shown_of(row, c, pairs, deficient):
    """The row with times a pair, and without ranks that say nothing."""
    shown = dict(row)
    for work in ("matrix", "gradient", "fused"):
        shown["." + work] = 1e6 * row[work].median() / pairs if row[work] and pairs else None
    for name in (".rank0", ".rank1", ".rank2", ".rank3", ".decomposed"):
        if row["method"] == "SPH" or not (deficient or is_given(c)) or name > f".rank{c['dimension']}":
            shown[name] = None
    return shown


def show_turned(rows):
    """Rows as columns. A line without any value is left out."""
    for line in LINES:
        if line is None:
            print()
            continue
        head, name, *form = line
        values = [row[name] for row in rows]
        if any(value is not None for value in values):
            print(f"  {head:20}" + "".join(
                f"{milliseconds(v.median()) if isinstance(v, Time) else text_of(v, *form):>13}" for v in values))
        if any(isinstance(value, Time) for value in values):
            print(f"  {'  min-max':20}" + "".join(
                f"{'-'.join(map(milliseconds, v.spread()[1:])) if v else '':>13}" for v in values))


def print_suspect(c, kgc):
    """Volumes are what a file gets wrong most easily, and what lambda takes as it is."""
    if not is_given(c) or kgc[f".rank{c['dimension']}"] >= c["particles"] / 10:
        return
    suspect = f"--support, which leaves {c['pairs_per_particle']:.2g} neighbours a particle." \
        if c["pairs_per_particle"] < c["dimension"] else \
        f"the unit of the volumes (mass / density),\nwhich are {c['.volume_ratio']:.2g} times what the positions give (1 / sum W)."
    print(f"\nHardly any particle has full rank. First suspect: {suspect}")


def print_footer(c, rows, deficient):
    print(f"\nerror: max |J_i - J|_F / |J|_F on {formula(c)} over all particles{' of' if deficient else ', all of'} rank "
          f"{c['dimension']}{' (SPH: over all)' if deficient else ''}")
    if is_given(c) and c["precision"] == "mixed":
        print("(mixed: v itself is rounded to f32 here, which shows as error)")
    not_finite = sum(row[".not_finite"] for row in rows)
    print(f"NOT FINITE: {not_finite} numbers of the Jacobians are NaN or infinite" if not_finite else
          "all numbers of all Jacobians are finite")
    print("+weights: the sweep before, which is not timed, kept what kernel and volume give each pair\n"
          "paper: one million particles on 32 cores of a Threadripper PRO 5975WX")
