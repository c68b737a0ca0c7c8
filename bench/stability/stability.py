# SPDX-License-Identifier: MIT
import math
import os
import re
import sys
from report import BENCH, grouped, plural, show

METHODS = ("KGC", "MLS", "RKPM", "CMLS", "CRKPM", "SPH")
ORDER_2 = ("curvature", "thinning")


def ratio_of(row):
    return max(row["ratio_full"], row["ratio_touched"])


def largest(values):
    """NaN is not overlooked."""
    values = list(values)
    return next((value for value in values if value != value), max(values, default=0.0))


def report_of(report):
    c, rows = report.context, report.rows("stability")
    print(f"particles  {grouped(c['.block'])} in the largest block, jitter {c['jitter']:g} spacings, H = "
          f"{c['support_spacings']:g} spacings, {c['.kernel']}, eps 1e-2, but\n           for what a sweep changes; "
          f"{plural(c['rounds'], 'round')} of random numbers, seed {c['seed']}")
    report.print_machine()
    print("ratios     largest error of the gradient of a random field over its bound, beside brute force in\n"
          "           quadruple precision; limits: 10 at full rank, 16 where the threshold acts; order 2: 1 and 4\n"
          "ranks      means over the particles of a case, least and most; decomposed: their share in percent")
    show_summaries(rows)
    if c[".alone"]:
        show_places(rows)
    report.write_csv(rows, "stability.csv")
    if c[".all"]:
        for name in ("ratios", "ranks", "reading"):
            report.draw(f"stability_{name}.gp", ["stability/stability_common.gp", f"stability/stability_{name}.gp"],
                        support=f"{c['support_spacings']:g}", machine=c["cpu_model"])
    report.print_written("stability.csv" + ", three scripts" * c[".all"], " and their pictures" if c[".all"] else "")
    check_promises(report, rows)


def show_summaries(rows):
    """All cases of a sweep and method."""
    table = []
    for sweep in dict.fromkeys(row["sweep"] for row in rows):
        for method in METHODS:
            cases = [row for row in rows if (row["sweep"], row["method"]) == (sweep, method)]
            if not cases:
                continue
            ranks, shares = [row["rank"] for row in cases], [100 * row["decomposed"] for row in cases]
            found = {"sweep": sweep, "method": method, "cases": len(cases), "ranks": None, "shares": None}
            found |= {key: sum(row[key] for row in cases)
                      for key in ("targets", "compared", "wrong_ranks", "other_bits", "not_finite")}
            found |= {precision: largest(ratio_of(row) for row in cases if row["precision"] == precision)
                      for precision in ("f32", "f64", "mixed")}
            if max(ranks) > 0:
                found |= {"ranks": f"{min(ranks):.2f} - {max(ranks):.2f}", "shares": f"{min(shares):.1f} - {max(shares):.1f}"}
            table.append(found)
    show(table, (("sweep", "sweep"), ("method", "method"), ("cases", "cases"), ("targets", "targets"),
                 ("compared", "compared"), ("f32", "f32", "%.2g"), ("f64", "f64", "%.2g"), ("mixed", "mixed", "%.2g"),
                 ("rank", "ranks"), ("decomposed", "shares"), ("wrong", "wrong_ranks"), ("bits", "other_bits"),
                 ("not finite", "not_finite")))


def show_places(rows):
    """One sweep alone, place by place."""
    print("\nplaces     f32, but for the last columns; rank: particles of full rank, decomposed: shares in percent;\n"
          "           linear: mean error of a linear field, noise: largest |J| H of a random field; exact: the\n"
          "           largest error of a linear field at full rank, bound: the largest error of a random field\n"
          "           over its bound")
    wide = {(row["method"], row["policy"], row["at"]): row for row in rows if row["precision"] == "f64"}
    table = []
    for row in rows:
        if row["precision"] == "f32":
            other = wide.get((row["method"], row["policy"], row["at"]), row)
            table.append(row | {"full": 100 * row["full"], "decomposed": 100 * row["decomposed"], "wide": other["linear_full"],
                                "bound": ratio_of(row), "wide bound": ratio_of(other)})
    show(table, (("sweep", "sweep"), ("at", "at", "%.3g"), ("method", "method"), ("policy", "policy"), ("targets", "targets"),
                 ("rank", "full", "%.2f"), ("decomposed", "decomposed", "%.2f"), ("linear", "linear_mean", "%.2g"),
                 ("noise", "noise", "%.2g"), ("exact f32", "linear_full", "%.1g"), ("f64", "wide", "%.1g"),
                 ("bound f32", "bound", "%.2g"), ("f64", "wide bound", "%.2g")))


def check_promises(report, rows):
    """What no case may break: a line on stderr each. NaN is never within. The limits of errors are those of the tests."""
    c = report.context
    with open(os.path.join(BENCH, "..", "tests", "support", "tolerances.h"), encoding="utf-8") as file:
        limits = {name: float(limit) for name, limit in re.findall(r"X\((\w+), ([-+.\de]+),", file.read())}

    def require(row, holds, text):
        if not holds:
            report.failed = True
            print(f"BROKEN     {row['sweep']} at {row['at']:g}, {row['method']}, {row['precision']}, {row['policy']}: {text}",
                  file=sys.stderr)

    for row, following in zip(rows, rows[1:] + [None]):
        sweep, rank = row["sweep"], row["rank"]
        require(row, row["not_finite"] == 0, f"{row['not_finite']} numbers are not finite")
        if sweep != "crowds":  # where sums of equal terms drift one way
            require(row, row["ratio_full"] <= limits["quadratic_ratio_full" if sweep in ORDER_2 else "oracle_ratio_full"],
                    f"error {row['ratio_full']:g} times its bound at full rank")
            require(row, row["ratio_touched"] <= limits["quadratic_ratio_touched" if sweep in ORDER_2 else "oracle_ratio_touched"],
                    f"error {row['ratio_touched']:g} times its bound under the threshold")
        require(row, row["wrong_ranks"] == 0, f"{row['wrong_ranks']} ranks are not those of the reference")
        require(row, row["compared"] > 0 or c[".compared"] == 0, "nothing was compared")
        require(row, row["other_bits"] == 0, f"{row['other_bits']} targets changed with the unit of length")
        if sweep == "merging" and row["policy"] == "blend":
            # A continuous C changes by a 256th in a 256th of a step; rounding adds u |C|, the curve of f a little.
            # Under the other policies the jump stays.
            u = 2.0**-53 if row["precision"] == "f64" else 2.0**-24
            require(row, row["jump_left"] <= row["jump"] / 32 + 4096 * u * (1 + row["noise"]),
                    f"a jump of {row['jump']:g} is still {row['jump_left']:g} after 256 times smaller steps")
        if row["method"] == "SPH":
            continue
        if sweep == "neighbours":
            # n neighbours leave at most n directions, and nobody falls back who has none.
            require(row, rank <= row["at"], f"mean rank {rank:g}")
            require(row, row["at"] > 0 or row["empty"] == 0 or
                    row["empty"] + round(row["full"] * row["targets"]) == row["targets"], f"{row['empty']} empty")
        if sweep == "slab":
            # A slab that becomes thinner does not win directions, and ends as a plane. It may win some while q^2 W
            # between its layers still grows, with the narrowest kernel (Wendland C6) down to q = 0.3.
            if following and all(following[key] == row[key] for key in ("sweep", "method", "policy", "precision")):
                require(following, following["rank"] <= rank or
                        c["support_spacings"] * math.sqrt(row["at"]) < 1 / 0.3,
                        f"mean rank rises from {rank:g} to {following['rank']:g}")
            else:
                require(row, rank <= 2, f"a plane has mean rank {rank:g}")
