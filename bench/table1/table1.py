# SPDX-License-Identifier: MIT
"""Table 1 as the paper has it, methods side by side, and what it was measured on."""
import statistics
from __main__ import Table, grouped, milliseconds

kept = []


def keep(report):
    """Of the search and the probe, which have rows of their own."""
    kept.append(report.table_now.keyed()[0])


def print_particles(c):
    if c["particles_from"] != "lattice":
        print(f"particles  {grouped(c['particles'])} of {c['particles_from']}{', ' if c['.flat'] else ''}{c['.flat']}")
        if c[".frames"]:
            print("           the first of several frames in the file")
        order = "shuffled" if c["order"] == "shuffled" else "file's"
        print(f"           columns {c['.columns']}\n           {order} order, volume {c['.volume']}, timed field: " +
              (f"{c['.velocities']} velocities" if c[".velocities"] else formula(c)))
        return
    nearest = f" (the cube nearest to {grouped(c['.wanted'])})" if c["particles"] != c[".wanted"] else ""
    moved = f"each coordinate moved by up to {c['jitter']:g} spacings, " if c["jitter"] > 0 else ""
    print(f"particles  {grouped(c['particles'])} in a lattice of {' x '.join(3 * [str(c['.side'])])}{nearest}, spacing 1/128\n"
          f"           {moved}{c['order']} order, volume {c['.volume']}")


def formula(c):
    return "v = (-y, x, 2z)" if c["dimension"] == 3 else "v = (-y, x)"


def print_set_up(report, c, pairs, kgc):
    search, probe = kept
    median, least, most = map(milliseconds, search["search"].spread())
    print("Table 1 of Westhofen, Jeske, Bender 2023, doi:10.1145/3606933\n")
    print_particles(c)
    print(f"scheme     {c['.kernel']}, H = {c['support_spacings']:g}"
          f"{' spacings' if c['particles_from'] == 'lattice' else ''}, threshold 0.01 (blend), {c['precision']}"
          f"{': positions f64, the rest f32' if c['precision'] == 'mixed' else ''}")
    report.machine()
    each = f", {1e6 * statistics.median(search['search'].wall) / pairs:.3f} ns a pair" if pairs else ""
    print(f"pairs      {grouped(pairs)}, {c['pairs_per_particle']:.2f} a particle; {c['bytes_per_particle']:.1f} bytes a "
          f"particle held by the neighbours\nsearch     T_ns {median} ms ({least}-{most}){each}; the first, with allocation, "
          f"{milliseconds(c['search_first_ms'])} ms")
    # How much longer a particle takes here than with the probe.
    times = [probe[work].spread()[0] for work in ("matrices", "gradient")]
    over = [kgc[work].spread()[0] / c["particles"] / (time / probe["particles"])
            for work, time in zip(("matrix", "gradient"), times)]
    print(f"yardstick  {milliseconds(times[0])} and {milliseconds(times[1])} ms for matrices and gradient of "
          f"{grouped(probe['particles'])} particles by `limit --probe`;\n           a particle's T_mat and T_grad of KGC take "
          f"{over[0]:.2f} and {over[1]:.2f} of its")


def table1(report):
    c, rows = report.context, report.table_now.keyed()
    pairs, dimension = round(c["pairs_per_particle"] * c["particles"]), c["dimension"]
    given = c["particles_from"] != "lattice"
    deficient = any(row[f".rank{dimension}"] != c["particles"] for row in rows if row["method"] != "SPH")
    print_set_up(report, c, pairs, rows[1])
    repetitions = len(rows[0]["gradient"].wall)
    print(f"\nmedian of {repetitions} repetition{'s' * (repetitions > 1)} after a warm-up, methods in turn; search not "
          "included\n")
    table = Table(heads=[
        ("", None), ("T_mat   [ms]", None), ("T_grad  [ms]", None), ("fused   [ms]", None), ("T_mat  +weights [ms]", None),
        ("T_grad +weights [ms]", None), ("fused  +weights [ms]", None), ("", None), ("T_mat   [ns a pair]", "%.3f"),
        ("T_grad  [ns a pair]", "%.3f"), ("fused   [ns a pair]", "%.3f"), ("", None), ("error of T_grad", "%.2e"),
        ("error of fused", "%.2e"), ("rank 0", None), ("rank 1", None), ("rank 2", None), ("rank 3", None),
        ("to the eigensolver", None), ("", None), ("paper, T_mat  [ms]", "%.2f"), ("paper, T_grad [ms]", "%.2f")])
    table.columns[0] = ("", "method", None, None)
    for row in rows:
        times = [row[work] for work in ("matrix", "gradient", "fused")]
        ranks = [row[f".rank{k}"] if k <= dimension else None for k in range(4)] + [row[".decomposed"]]
        table.rows.append(
            [row["method"], *times, *(row[work + "+weights"] for work in ("matrix", "gradient", "fused")), None,
             *(1e6 * statistics.median(time.wall) / pairs if time and pairs else None for time in times), None,
             row["gradient_error"], row["fused_error"],
             *(ranks if row["method"] != "SPH" and (deficient or given) else [None] * 5), None,
             row["paper_matrix"], row["paper_gradient"]])
    table.turned()
    # Volumes are what a file gets wrong most easily, and what lambda takes as it is.
    if given and rows[1][f".rank{dimension}"] < c["particles"] / 10:
        suspect = f"--support, which leaves {c['pairs_per_particle']:.2g} neighbours a particle." \
            if c["pairs_per_particle"] < dimension else \
            ("the unit of the volumes (mass / density),\nwhich are "
             f"{c['.volume_ratio']:.2g} times what the positions give (1 / sum W).")
        print(f"\nHardly any particle has full rank. First suspect: {suspect}")
    print(f"\nerror: max |J_i - J|_F / |J|_F on {formula(c)} over all particles{' of' if deficient else ', all of'} rank "
          f"{dimension}{' (SPH: over all)' if deficient else ''}")
    if given and c["precision"] == "mixed":
        print("(mixed: v itself is rounded to f32 here, which shows as error)")
    not_finite = sum(row[".not_finite"] for row in rows)
    print(f"NOT FINITE: {not_finite} numbers of the Jacobians are NaN or infinite" if not_finite else
          "all numbers of all Jacobians are finite")
    print("+weights: the sweep before, which is not timed, kept what kernel and volume give each pair\n"
          "paper: one million particles on 32 cores of a Threadripper PRO 5975WX")
