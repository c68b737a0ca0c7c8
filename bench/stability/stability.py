# SPDX-License-Identifier: MIT
"""What the cases of the sweeps come to, and which promise one breaks."""
import math
import sys
from __main__ import Table

ORDER_2 = ("curvature", "thinning")


def ratio_of(row):
    return max(row["ratio_full"], row["ratio_touched"])


def largest(values):
    """NaN is not overlooked."""
    values = list(values)
    return next((value for value in values if value != value), max(values, default=0.0))


def summaries(report):
    """All cases of a sweep and method."""
    groups = {}
    for row in report.table_now.keyed():
        groups.setdefault((row["sweep"], row["method"]), []).append(row)
    table = Table(heads=[(head, "%.2g") for head in ("sweep", "method", "cases", "targets", "compared", "f32", "f64", "mixed",
                                                     "rank", "decomposed", "wrong", "bits", "not finite")])
    methods = {"KGC": 0, "MLS": 1, "RKPM": 2, "CMLS": 3, "CRKPM": 4, "SPH": 5}
    sweeps = list(dict.fromkeys(sweep for sweep, _ in groups))
    for (sweep, method), rows in sorted(groups.items(), key=lambda g: (sweeps.index(g[0][0]), methods[g[0][1]])):
        ranks, shares = [row["rank"] for row in rows], [100 * row["decomposed"] for row in rows]
        total = {key: sum(row[key] for row in rows)
                 for key in ("targets", "compared", "wrong_ranks", "other_bits", "not_finite")}
        ratios = [largest(ratio_of(row) for row in rows if row["precision"] == precision)
                  for precision in ("f32", "f64", "mixed")]
        ranked = max(ranks) > 0
        table.rows.append([sweep, method, len(rows), total["targets"], total["compared"], *ratios,
                           f"{min(ranks):.2f} - {max(ranks):.2f}" if ranked else None,
                           f"{min(shares):.1f} - {max(shares):.1f}" if ranked else None,
                           total["wrong_ranks"], total["other_bits"], total["not_finite"]])
    table.print()


def places(report):
    """One sweep alone, place by place."""
    print("\nplaces     f32, but for the last columns; rank: particles of full rank, decomposed: shares in percent;\n"
          "           linear: mean error of a linear field, noise: largest |J| H of a random field; exact: the\n"
          "           largest error of a linear field at full rank, bound: the largest error of a random field\n"
          "           over its bound")
    rows = report.table_now.keyed()
    wide = {(row["method"], row["policy"], row["at"]): row for row in rows if row["precision"] == "f64"}
    table = Table(heads=[("sweep", None), ("at", "%.3g"), ("method", None), ("policy", None), ("targets", None),
                         ("rank", "%.2f"), ("decomposed", "%.2f"), ("linear", "%.2g"), ("noise", "%.2g"),
                         ("exact f32", "%.1g"), ("f64", "%.1g"), ("bound f32", "%.2g"), ("f64", "%.2g")])
    for row in rows:
        if row["precision"] == "f32":
            other = wide.get((row["method"], row["policy"], row["at"]), row)
            table.rows.append([row["sweep"], row["at"], row["method"], row["policy"], row["targets"], 100 * row["full"],
                               100 * row["decomposed"], row["linear_mean"], row["noise"], row["linear_full"],
                               other["linear_full"], ratio_of(row), ratio_of(other)])
    table.print()


def promises(report, compared, *limits):
    """What no case may break: a line on stderr each. NaN is never within."""
    full, touched, full_2, touched_2 = map(float, limits)
    rows = report.table_now.keyed()

    def require(row, holds, text):
        if not holds:
            report.failed = True
            print(f"BROKEN     {row['sweep']} at {row['at']:g}, {row['method']}, {row['precision']}, {row['policy']}: {text}",
                  file=sys.stderr)

    for row, following in zip(rows, rows[1:] + [None]):
        sweep, rank = row["sweep"], row["rank"]
        require(row, row["not_finite"] == 0, f"{row['not_finite']} numbers are not finite")
        if sweep != "crowds":  # where sums of equal terms drift one way
            require(row, row["ratio_full"] <= (full_2 if sweep in ORDER_2 else full),
                    f"error {row['ratio_full']:g} times its bound at full rank")
            require(row, row["ratio_touched"] <= (touched_2 if sweep in ORDER_2 else touched),
                    f"error {row['ratio_touched']:g} times its bound under the threshold")
        require(row, row["wrong_ranks"] == 0, f"{row['wrong_ranks']} ranks are not those of the reference")
        require(row, row["compared"] > 0 or int(compared) == 0, "nothing was compared")
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
                        report.context["support_spacings"] * math.sqrt(row["at"]) < 1 / 0.3,
                        f"mean rank rises from {rank:g} to {following['rank']:g}")
            else:
                require(row, rank <= 2, f"a plane has mean rank {rank:g}")
