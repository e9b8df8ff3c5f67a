#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The tables of this study from direct.csv, chain.csv, cost.csv and gates.csv: study.py DIR

Writes held.csv (how often bars hold) and summary.txt. An interval of the chain is Jeffreys' of so many
trials (lattice/statistics/share_95.h): that number is found from its width. What direct trials then show has
the beta-binomial distribution, and where their count lies in it (its probability integral, at random within
the count's own step) should be uniform: within the middle 95 % of it for 95 % of the starts.
"""
import csv, math, random, sys
from collections import defaultdict
from pathlib import Path

from common import ENDINGS, GATES, LAYER, STARTS, key_of

folder = Path(sys.argv[1])
own = random.Random(2)


def log_beta(a, b):
    return math.lgamma(a) + math.lgamma(b) - math.lgamma(a + b)


def trials_behind(share, low, high):
    """So many trials as make an interval of this width; that of Jeffreys falls nearly as 1 / sqrt(n)."""
    n = share * (1 - share) * (2 * 1.96 / (high - low)) ** 2
    for _ in range(6):
        a, b = n * share + 0.5, n * (1 - share) + 0.5
        n *= ((beta_quantile(0.975, a, b) - beta_quantile(0.025, a, b)) / (high - low)) ** 2
    return n


def beta_below(x, a, b):
    """The distribution function of the beta distribution, by its continued fraction (Lentz)."""
    if x <= 0.0 or x >= 1.0:
        return float(x >= 1.0)
    if x > (a + 1) / (a + b + 2):
        return 1.0 - beta_below(1.0 - x, b, a)
    c, d = 1.0, 1.0 / (1.0 - (a + b) * x / (a + 1))
    f = d
    for m in range(1, 500):
        for up in (m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
                   -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))):
            d = 1.0 / (1.0 + up * d)
            c = 1.0 + up / c
            f *= c * d
        if abs(c * d - 1.0) < 1e-12:
            break
    return math.exp(a * math.log(x) + b * math.log1p(-x) - log_beta(a, b)) / a * f


def beta_quantile(p, a, b):
    low, high = 0.0, 1.0
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if beta_below(middle, a, b) < p else (low, middle)
    return 0.5 * (low + high)


def integral(count, n, a, b):
    """Of a count of n trials whose share has the beta distribution: the chance of less, and of a
    part of its own chance that is drawn."""
    def chance(k):
        return math.exp(math.lgamma(n + 1) - math.lgamma(k + 1) - math.lgamma(n - k + 1)
                        + log_beta(a + k, b + n - k) - log_beta(a, b))
    return sum(map(chance, range(count))) + own.random() * chance(count)


def total_variation(p, q):
    return 0.5 * sum(abs(x - y) for x, y in zip(p, q))


def drawn_total_variation(p, n, draws=200):
    """What n trials of these shares are off by: mean, and 95 times in 100 at most."""
    index = range(len(p))
    off = []
    for _ in range(draws):
        counts = [0] * len(p)
        for i in own.choices(index, weights=p, k=n):
            counts[i] += 1
        off.append(total_variation(p, [c / n for c in counts]))
    off.sort()
    return sum(off) / draws, off[math.ceil(0.95 * draws) - 1]


def numbers(row, names):
    return [float(row[name]) for name in names]


def direct_trials():
    """By start: trials, counts of endings and of gates; seconds of a trial."""
    found = {key_of(s): [0, [0] * len(ENDINGS), [0] * len(GATES)] for s in STARTS}
    cpu = 0.0
    for r in csv.DictReader((folder / "direct.csv").open()):
        t = found[r["start"]]
        t[0] += int(r["trials"])
        t[1] = [x + int(r[e]) for x, e in zip(t[1], ENDINGS)]
        t[2] = [x + int(r[g]) for x, g in zip(t[2], GATES)]
        cpu += float(r["cpu_s"])
    return found, cpu / sum(t[0] for t in found.values())


TESTED = ENDINGS[1:]  # bodies that cross are too few


ALIKE = "all starts alike"


def alike(row, direct):
    """A control that should fail: one answer for all starts, all their trials together, with the
    bars of this row."""
    n = sum(t[0] for t in direct.values())
    row = row | {"what": ALIKE}
    for i, e in enumerate(ENDINGS):
        share, low, high = numbers(row, [e, e + "_low", e + "_high"])
        by = sum(t[1][i] for t in direct.values()) / n - share
        row |= {e: share + by, e + "_low": low + by, e + "_high": high + by}
    return row | {g: sum(t[2][i] for t in direct.values()) / n for i, g in enumerate(GATES)}


def held_rows(direct):
    """For each pool and start: the integral of every ending, the distance of the final gates and its
    bar with the chance of the trials."""
    chance = {}
    pools = [r for r in csv.DictReader((folder / "chain.csv").open()) if r["start"]]
    for r in pools + [alike(r, direct) for r in pools if (r["what"], r["seed"]) == ("pool", "1")]:
        n, endings, gates = direct[r["start"]]
        line = dict(what=r["what"], seed=r["seed"], start=r["start"], trials=n, unseen=float(r["unseen"]))
        for e in TESTED:
            share, low, high = numbers(r, [e, e + "_low", e + "_high"])
            count = endings[ENDINGS.index(e)]
            like = trials_behind(share, low, high)
            line |= {e: count / n, e + "_chain": share, e + "_half": 0.5 * (high - low),
                     e + "_integral": integral(count, n, like * share + 0.5, like * (1 - share) + 0.5)}
        p = numbers(r, GATES)
        key = r["start"], r["what"] == ALIKE
        if key not in chance:
            chance[key] = drawn_total_variation(p, n)
        mean, most = chance[key]
        line |= dict(distance=total_variation(p, [c / n for c in gates]), bar=float(r["error_95"]),
                     chance_mean=mean, chance_95=most)
        yield line


def per_cent(part, whole):
    return f"{100 * part / whole:.1f} % ({part} of {whole})"


def summary(rows):
    lines = []
    pools = defaultdict(list)
    for r in rows:
        pools[f"{r['what']} {r['seed']}"].append(r)
    for what in dict.fromkeys(r["what"] for r in rows):
        if what != ALIKE:
            pools[f"{what}, all"] = [r for r in rows if r["what"] == what]
    lines += ["bars that hold, by pool: within the middle 95 % of the probability integral",
              "pool  " + "  ".join(TESTED) + "  final gates"]
    for name, g in pools.items():
        inside = [sum(0.025 <= r[e + "_integral"] <= 0.975 for r in g) for e in TESTED]
        gates = sum(r["distance"] <= math.hypot(r["bar"], r["chance_95"]) for r in g)
        lines.append(f"{name}: " + "  ".join(per_cent(x, len(g)) for x in [*inside, gates]))
    lines += ["", "mean over the starts of a pool of the probability integral, trapped: " +
              ", ".join(f"{name} {sum(r['trapped_integral'] for r in g) / len(g):.2f}" for name, g in pools.items())]
    lines += ["", "direct less chain: mean over starts, and its error by the direct trials' chance alone; the",
              "chain's variance (squares of differences, less the direct trials' chance) over what its bars say"]
    for name, g in pools.items():
        for e in TESTED:
            off = [r[e] - r[e + "_chain"] for r in g]
            noise = [r[e + "_chain"] * (1 - r[e + "_chain"]) / r["trials"] for r in g]
            said = [(r[e + "_half"] / 1.96) ** 2 for r in g]
            lines.append(f"{name}, {e}: {100 * sum(off) / len(g):+.2f} % ({100 * math.sqrt(sum(noise)) / len(g):.2f}), "
                         f"half a bar {100 * sum(r[e + '_half'] for r in g) / len(g):.1f} %, "
                         f"half that of the direct trials {196 * math.sqrt(sum(noise) / len(g)):.1f} %, variance "
                         f"{(sum(x * x for x in off) - sum(noise)) / sum(said):.2f} of what is said")
        distance, chance = (sum(r[k] for r in g) / len(g) for k in ("distance", "chance_mean"))
        lines.append(f"{name}, final gates: mean distance {distance:.4f}, of the direct trials' chance {chance:.4f}, so "
                     f"the chain's {math.sqrt(max(0, distance ** 2 - chance ** 2)):.4f}; mean bar "
                     f"{sum(r['bar'] for r in g) / len(g):.4f}; unseen entries at most {max(r['unseen'] for r in g):.4f}")
    return lines


def trials_for(bar, trials, chance_95):
    """So many direct trials as would have this error bar, from the chance of some."""
    return trials * (chance_95 / bar) ** 2


def cost_lines(rows, seconds_per_trial):
    cost = defaultdict(float)
    runs = defaultdict(int)
    for r in csv.DictReader((folder / "cost.csv").open()):
        cost[r["what"], r["step"], r["seed"]] += float(r["cpu_s"])
        runs[r["what"], r["step"], r["seed"]] += int(r["runs"] or 0)
    lines = ["", "seconds of CPU, gatewalk and program together",
             f"a direct trial {1e3 * seconds_per_trial:.2f} ms (mean over all starts)"]
    ratios = []
    for seed in sorted({r["seed"] for r in rows if r["what"] == "pool"}):
        g = [r for r in rows if (r["what"], r["seed"]) == ("pool", seed)]
        need = sum(trials_for(r["bar"], r["trials"], r["chance_95"]) for r in g)
        pool, first = cost["pool", "pool", seed], cost["pool", "starts", seed]
        ratios.append(need * seconds_per_trial / (pool + first))
        lines.append(f"pool {seed}: pool {pool:.1f} s, first runs and answers of {len(g)} starts {first:.1f} s; direct trials "
                     f"to the same bars {need:.0f} in all, {need * seconds_per_trial:.0f} s: {ratios[-1]:.1f} times as much")
    for what in dict.fromkeys(r["what"] for r in rows if r["what"] != ALIKE):
        lines.append(f"{what}: gate runs of each " + ", ".join(str(n) for (w, step, _), n in runs.items() if (w, step) == (what, "pool")))
    g = [r for r in rows if r["what"] == "pool"]
    distance, chance = (sum(r[k] for r in g) / len(g) for k in ("distance", "chance_mean"))
    need = sum(r["trials"] for r in g) * chance ** 2 / (distance ** 2 - chance ** 2)
    took = sum(t for (what, *_), t in cost.items() if what == "pool")
    lines.append(f"to the same mean error of the final gates, by the direct trials: {need * seconds_per_trial / took:.1f} times as much")
    lines.append(f"{len(STARTS)} starts, mean of the pools: {sum(ratios) / len(ratios):.1f} times")
    return lines, cost, runs


def engine_lines(cost, runs):
    """Chain beside direct trials, by engine; writes endings.csv."""
    chains = {r["what"]: r for r in csv.DictReader((folder / "chain.csv").open()) if not r["start"]}
    lines = ["", "from the start of the scene: % of bodies [95 %]; final gates in total variation"]
    gates, table = {}, []
    for r in csv.DictReader((folder / "engines.csv").open()):
        what, n = r["what"], int(r["trials"])
        chain = chains[f"chain, {what}"]
        shares = {"direct": [], "chain": [numbers(chain, [e, e + "_low", e + "_high"]) for e in ENDINGS]}
        for e in ENDINGS:
            k = int(r[e])
            shares["direct"].append((k / n, *(beta_quantile(q, k + 0.5, n - k + 0.5) if 0 < k or q > 0.5 else 0.0
                                              for q in (0.025, 0.975))))
        for route in shares:
            table += [(what, route, e, *x) for e, x in zip(ENDINGS, shares[route]) if e in TESTED]
            lines.append(f"{what}, {route}: " + ", ".join(f"{e} {100 * x:.2f} [{100 * low:.2f}, {100 * high:.2f}]"
                                                          for e, (x, low, high) in zip(ENDINGS, shares[route])))
        p, q = numbers(chain, GATES), [x / n for x in numbers(r, GATES)]
        gates[what] = q, n
        mean, most = drawn_total_variation(p, n)
        bar = float(chain["error_95"])
        need = trials_for(bar, n, most)
        took = cost[f"chain, {what}", "all", "1"]
        per_trial = float(r["cpu_s"]) / n
        lines.append(f"{what}: chain and direct trials apart {total_variation(p, q):.4f}, floor {mean:.4f} (95 %: {most:.4f}), "
                     f"the chain's bar {bar:.4f} from {runs[f'chain, {what}', 'all', '1']} gate runs, answer from {chain['answer_from']}")
        lines.append(f"{what}: {took:.1f} s; direct trials to the same bar {need:.0f}, {need * per_trial:.1f} s: "
                     f"{need * per_trial / took:.1f} times as much ({1e3 * per_trial:.3f} ms a trial)")
    (p, n), (q, m) = gates.values()
    off = [drawn_total_variation(q, k)[0] for k in (n, m)]
    lines.append(f"direct trials of the engines apart {total_variation(p, q):.4f}, floor {math.hypot(*off):.4f}")
    with open(folder / "endings.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["what", "route", "ending", "share", "low", "high"])
        out.writerows(table)
    lines += ["", "out of the first gate, % of passages (standard error)"]
    for r in csv.DictReader((folder / "gates.csv").open()):
        n = int(r["passages"])
        shares = {f: int(r[f]) / n for f in ("EN", "LD", "RD", "LT", "RT", "trapped")}
        lines.append(f"{r['what']}, {n}: " + ", ".join(
            f"{f} {100 * x:.2f} ({100 * math.sqrt(x * (1 - x) / n):.2f})" for f, x in shares.items())
            + f", {r['mean_time_s']} s" + (f", {100 * float(r['as_Chipmunk']):.1f} % as Chipmunk" if r["as_Chipmunk"] else ""))
    return lines


def main():
    direct, seconds_per_trial = direct_trials()
    rows = list(held_rows(direct))
    with open(folder / "held.csv", "w", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        table.writeheader()
        table.writerows({k: round(v, 6) if isinstance(v, float) else v for k, v in r.items()} for r in rows)
    costs, cost, runs = cost_lines(rows, seconds_per_trial)
    crossed = sum(t[1][0] for t in direct.values()), sum(t[0] for t in direct.values())
    lines = [f"{len(direct)} starts, {crossed[1]} direct trials, {crossed[0]} crossed", ""]
    lines += summary(rows) + costs + engine_lines(cost, runs)
    took = {name: sum(float(r["cpu_s"]) for r in csv.DictReader((folder / name).open()))
            for name in ("direct.csv", "cost.csv", "engines.csv", "gates.csv")}
    lines += ["", "seconds of CPU behind the tables: " + ", ".join(f"{k} {v:.0f}" for k, v in took.items()) +
              f", in all {sum(took.values()):.0f}"]
    (folder / "summary.txt").write_text("\n".join(lines) + "\n")


main()
