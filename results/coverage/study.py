#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How often 95 % intervals hold the truth: study.py GATEWALK DIR [COMMAND...].

Each kind of interval is a row: of predictions from a scene's own start, of predictions from starts that a
chain was not built with, of the full dynamics, and of what else prints intervals: analyze, validate, power, rare,
build. With commands named, only their rows are made anew; the others stay. Truth: 10^6 full trials of another
seed (of costs and rows 100 000; of unseen starts 150 000, from results/tree, or 400 000), whose own noise is allowed
for: added in squares to the half of the interval on the truth's side, or to the bar. Rare: shares of which fewer
than ten trials are expected in what the answer was made from; an interval of such a share can only say "at most",
and should hold more often.

The answers of one command with one seed share its runs: they are one pool. The 99 % interval of a coverage takes pools,
not answers, as independent (Korn and Graubard, Confidence intervals for proportions with small expected number of
positive counts estimated from survey data, Surv. Methodol. 24, 1998). A kind *meets* if it contains some of 94 to 96 %.
"""
import csv, importlib.util, json, math, os, random, statistics, subprocess, sys, tempfile
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

OUT = Path(sys.argv[2])
ROOT = Path(__file__).resolve().parents[2]
spec = importlib.util.spec_from_file_location("tree", ROOT / "results/tree/study.py")
tree = importlib.util.module_from_spec(spec)
spec.loader.exec_module(tree)
run, flat, tv, noise_tv = tree.run, tree.flat, tree.tv, tree.expected_tv

SCENES = {
    **{s: tree.SCENES[s] for s in "ABC"},
    "robot": tree.SCENES["R"],
    "mixed": [str(ROOT / "scenes/mixed.toml"), "--set", "run.method=moreau"],
}
# A cell program with 3, 5 and 8 coordinates: place and velocity; heading and turning rate; phase, stride and load.
LEGS = ("legs3", "legs5", "legs8")
LEGS_START = {"d_m": 0.01, "vx_m_per_s": 0, "vy_m_per_s": 0.25, "heading_rad": 0, "turn_rad_per_s": 0, "phase": 0.5,
              "stride": 1, "load": 1}
TRUTH_TRIALS, ACCURACY = 1_000_000, 0.04
FIRST_SEED = 2001  # the rules were chosen on others
# Of each scene.
SEEDS_OF = {"predict": 130, "lattice": 200, "analyze": 60, "validate": 60, "power": 2, "rare": 60, "build": 130,
            "recorded": 40, "imported": 100}
UNSEEN = {"A": 30, "B": 15, "C": 30, "M": 30, "R": 60}  # chains of results/tree's scenes, 24 starts each
LATTICE_TRIALS, VALIDATE_TRIALS, RARE_ROW, RARE_RUNS, MORE_TRUTH_TRIALS = 1000, 1000, 6, 100_000, 100_000
RECORDED_BODIES, IMPORTED_RUNS = 400, 60  # bodies; counts in each row
STRAIGHT_UP = "EN_12"  # the paper's bin of slow, straight entries from below
# Rows that count no 95 % intervals.
NO_INTERVALS = ("power: as", "predict: no assumption")
COSTS = ("time_s", "forward_m", "work_J", "random_work_J", "lost_J")


def seeds_of(command):
    return range(FIRST_SEED, FIRST_SEED + SEEDS_OF[command])


def make_legs(folder):
    """Compiles the cell program; adds its scenes, whose cells are as its first line says."""
    program = folder / "legged_body"
    subprocess.run(["c++", "-std=c++20", "-O2", ROOT / "scenes/programs/legged_body.cpp", "-o", program], check=True)
    for name in LEGS:
        coordinates = int(name[-1])
        said = subprocess.run([program, str(coordinates)], input="", capture_output=True, text=True, check=True)
        cell = json.loads(said.stdout)
        lines = ["[cell]", "width_m = 0.2", "length_m = 0.24"]
        for face in cell["faces"]:
            lines += ["[[cell.faces]]", f'name = "{face["name"]}"', f'move = {face["move"]}']
        for c in cell["coordinates"]:
            lines += ["[[cell.coordinates]]", f'name = "{c["name"]}"', f'unit = "{c["unit"]}"', f'scale = {c["scale"]}']
        lines += ["[field]", "columns = 9", "rows = 9", "max_gates = 15", "[start]", 'face = "S"']
        lines += [f"{key} = {value}" for key, value in list(LEGS_START.items())[:coordinates]]
        toml = folder / f"{name}.toml"
        toml.write_text("\n".join(lines) + "\n")
        SCENES[name] = [str(toml), "--cell-program", f"{program} {coordinates}"]


def truth_of(scene):
    """Shares by 10^6 trials, in parts that run side by side."""
    def part(seed):
        j = run("lattice", *SCENES[scene], "--trials", TRUTH_TRIALS // 4, "--seed", seed)
        return j

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        parts = list(pool.map(part, range(9001, 9005)))
    n = TRUTH_TRIALS
    mean = lambda values: sum(values) / len(values)
    return {"endings": {e: mean([p["endings"][e] / (n // 4) for p in parts]) for e in parts[0]["endings"]},
            "final_gates": [mean(x) / (n // 4) for x in zip(*(flat(p["final_gates"]) for p in parts))],
            "exits": {side: [mean([p["exits"][side][i]["share"] for p in parts])
                             for i in range(len(parts[0]["exits"][side]))] for side in parts[0]["exits"]}}


def more_truth_of(scene):
    """Costs by ending, and the chance to enter each row without limit of gates, by fewer trials."""
    costs = run("lattice", *SCENES[scene], "--trials", MORE_TRUTH_TRIALS, "--seed", 9008)["costs"]
    rows = run("rare", *SCENES[scene], "--row", RARE_ROW, "--split-trials", 8, "--trials", MORE_TRUTH_TRIALS,
               "--seed", 9009)
    mean_and_error = lambda own, c: {"mean": own[f"mean_{c}"], "error": own[f"sd_{c}"] / math.sqrt(own["trials"])}
    return {"costs": {e: {c: mean_and_error(own, c) for c in COSTS}
                      for e, own in costs.items() if own["trials"] >= 30},
            "rows": [r["direct_entered"] / MORE_TRUTH_TRIALS for r in rows["rows"]]}


def beta_chance(x, a, b):
    """The regularised incomplete beta function, by its continued fraction (Lentz's method)."""
    if x > (a + 1) / (a + b + 2):
        return 1 - beta_chance(1 - x, b, a)
    if x <= 0:
        return 0.0
    tiny, c, fraction = 1e-300, 1.0, 1 / (1 - (a + b) * x / (a + 1))
    d = fraction
    for m in range(1, 10_000):
        change = 1.0
        for term in (m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
                     -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))):
            d = 1 / ((1 + term * d) or tiny)
            c = (1 + term / c) or tiny
            change *= c * d
        fraction *= change
        if abs(change - 1) < 1e-13:
            break
    return fraction / a * math.exp(math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b)
                                   + a * math.log(x) + b * math.log1p(-x))


def beta_quantile(level, a, b):
    low, high = 0.0, 1.0
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if beta_chance(middle, a, b) < level else (low, middle)
    return (low + high) / 2


def t_995(freedom):
    """The 99.5 % quantile of Student's t, by Cornish and Fisher's expansion."""
    z = statistics.NormalDist().inv_cdf(0.995)
    return z + (z**3 + z) / (4 * freedom) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * freedom**2)


class Count:
    """Answers that hold, by kind and scene, and by pool."""

    LEAST_POOLS = 20  # fewer tell nothing of the spread between pools

    def __init__(self):
        self.held, self.of = (defaultdict(lambda: defaultdict(int)) for _ in range(2))
        self.pool = 0

    def next_pool(self):
        self.pool += 1

    def add(self, row, scene, holds):
        self.of[row, scene][self.pool] += 1
        self.held[row, scene][self.pool] += bool(holds)

    def line(self, row, names):
        """Pools, answers, coverage with its interval, verdict, scenes whose coverage is below, coverage by scene."""
        scenes = [s for s in names if (row, s) in self.of]
        pools, answers, coverage, interval = self.interval(row, scenes)
        percent = lambda share: "" if share is None else f"{100 * share:.1f}"
        each = {s: self.interval(row, [s]) for s in scenes}
        is_below = lambda limits: limits is not None and limits[1] < 0.94
        verdict = ""
        if interval and not row.startswith(NO_INTERVALS):
            verdict = "below" if is_below(interval) else "above" if interval[0] > 0.96 else "meets"
        low, high = interval or (None, None)
        return [pools, answers, percent(coverage), percent(low), percent(high), verdict,
                " ".join(s for s in scenes if verdict and is_below(each[s][3])),
                *(percent(each[s][2]) if s in each else "" for s in names)]

    def interval(self, row, scenes):
        """Pools, answers and coverage, with a 99 % interval of Korn and Graubard: that of Clopper and Pearson for as
        many independent answers as have the same error. Scenes are strata."""
        of, held = ([numbers[row, s] for s in scenes] for numbers in (self.of, self.held))
        pools, answers = sum(map(len, of)), sum(sum(n.values()) for n in of)
        p = sum(sum(h.values()) for h in held) / answers
        if pools < self.LEAST_POOLS:
            return pools, answers, p, None
        squares = 0.0
        for n, h in zip(of, held):
            share, m = sum(h.values()) / sum(n.values()), len(n)
            squares += sum((h[i] - share * n[i]) ** 2 for i in n) * m / max(1, m - 1)
        like = p * (1 - p) * answers ** 2 / squares if squares > 0 else pools
        like = min(answers, like * (t_995(answers - 1) / t_995(pools - len(scenes))) ** 2)
        k = p * like
        return pools, answers, p, (beta_quantile(0.005, k, like - k + 1) if k > 0 else 0.0,
                                   beta_quantile(0.995, k + 1, like - k) if k < like else 1.0)

    def share(self, row, scene, p, answer, interval, trials, truth_trials=TRUTH_TRIALS):
        """An interval of a share. Impossible ones, never seen in the truth, are not counted."""
        if p == 0.0:
            return
        noise = 1.96 * math.sqrt(p * (1 - p) / truth_trials)
        self.add(row + (" (rare)" if p * trials < 10 else ""), scene,
                 abs(p - answer) <= math.hypot(interval[p > answer] - answer, noise))


def rmse(p, q):
    return 100 * math.sqrt(sum((a - b) ** 2 for a, b in zip(p, q)) / len(p))


def corrcoef(p, q):
    mp, mq = sum(p) / len(p), sum(q) / len(q)
    return (sum((a - mp) * (b - mq) for a, b in zip(p, q)) /
            math.sqrt(sum((a - mp) ** 2 for a in p) * sum((b - mq) ** 2 for b in q)))


def gates_of(count, what, scene, j, truth, trials, truth_trials=TRUTH_TRIALS):
    for p, own, interval in zip(truth, flat(j["final_gates"]), flat(j["final_gates_95"])):
        count.share(f"{what}: a final gate", scene, p, own, interval, trials, truth_trials)


def predicted(count, scene, truth):
    def one(seed):
        return run("predict", *SCENES[scene], "--accuracy", ACCURACY, "--seed", seed)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for j in pool.map(one, seeds_of("predict")):
            count.next_pool()
            trials = j["first_runs"]
            answer, p = flat(j["final_gates"]), truth["final_gates"]
            count.add("predict: total variation", scene,
                      tv(answer, p) <= math.hypot(j["error_95"], noise_tv(p, TRUTH_TRIALS)))
            noise = 100 * math.sqrt(sum(x * (1 - x) for x in p) / TRUTH_TRIALS / len(p))
            count.add("predict: RMSE", scene, rmse(answer, p) <= math.hypot(j["rmse_per_100_95"], noise))
            if j["corrcoef_95"] is not None:
                count.add("predict: corrcoef", scene, corrcoef(answer, p) >= j["corrcoef_95"])
            for e, interval in j["endings_95"].items():
                count.share(f"predict: {e}", scene, truth["endings"][e], j["endings"][e], interval, trials)
            gates_of(count, "predict", scene, j, p, trials)
            for side, places in j["exits"].items():
                for q, place in zip(truth["exits"][side], places):
                    count.share("predict: where they leave", scene, q, place["share"], place["share_95"], trials)
            count.add("predict: no assumption said to be wrong", scene,
                      not any(check and check["wrong"] for check in j["assumptions"].values()))


def simulated(count, scene, truth):
    def one(seed):
        return run("lattice", *SCENES[scene], "--trials", LATTICE_TRIALS, "--seed", seed)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for j in pool.map(one, seeds_of("lattice")):
            count.next_pool()
            for e, interval in j["endings_95"].items():
                count.share(f"lattice: {e}", scene, truth["endings"][e], j["endings"][e] / LATTICE_TRIALS,
                            [limit / LATTICE_TRIALS for limit in interval], LATTICE_TRIALS)
            for side, places in j["exits"].items():
                for q, place in zip(truth["exits"][side], places):
                    count.share("lattice: where they leave", scene, q, place["share"], place["share_95"],
                                LATTICE_TRIALS)


def unseen_truths(truths):
    """Those of results/tree; of M and R ten times as many trials, because noise spreads over all gates and adds to the
    total variation of their few common ones."""
    tree.TRUTHS = truths.setdefault("unseen", {})
    for scene in "MR":
        tree.PLAN[scene]["many"] = [(9003, 400_000)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda work: tree.Truth(*work, "many"),
                      [(s, start) for s in "MR" for start in tree.hundred(s)[:tree.KNOWN]]))
    return json.loads((ROOT / "results/tree/truth.json").read_text()) | truths["unseen"]


def unseen(count, truths):
    """Starts as results/tree has them."""
    def one(work):
        scene, seed = work
        starts = tree.hundred(scene)[:tree.KNOWN]
        with tempfile.TemporaryDirectory() as folder:
            matrix = Path(folder) / "m.nc"
            run("build", *tree.SCENES[scene], "--accuracy", 0.06, "--starts", "all", "--seed", seed, "-o", matrix)
            words = [w for s in starts for w in ("--start", ",".join(map(str, s)))]
            return scene, starts, run("predict", matrix, *words, "--seed", seed)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for scene, starts, j in pool.map(one, [(s, FIRST_SEED + k) for s, n in UNSEEN.items() for k in range(n)]):
            count.next_pool()
            for s, a in zip(starts, j["starts"]):
                t = truths[f"{scene} {','.join(map(str, s))} many"]
                p = [n / t["trials"] for n in t["final_gates"]]
                answer = flat(a["final_gates"])
                count.add("predict, unseen start: total variation", scene,
                          tv(answer, p) <= math.hypot(a["error_95"], noise_tv(p, t["trials"])))
                noise = 100 * math.sqrt(sum(x * (1 - x) for x in p) / t["trials"] / len(p))
                count.add("predict, unseen start: RMSE", scene,
                          rmse(answer, p) <= math.hypot(a["rmse_per_100_95"], noise))
                gates_of(count, "predict, unseen start", scene, a, p, a["first_runs"], t["trials"])


def endings_of(count, what, scene, shares, intervals, truth, trials):
    for e, interval in intervals.items():
        count.share(f"{what}: {e}", scene, truth["endings"][e], shares[e], interval, trials)


def mean_of(count, row, scene, answer, interval, truth):
    """An interval of a mean, where there is one and the truth is known well enough."""
    p, noise = truth["mean"], 1.96 * truth["error"]
    if interval and noise <= 0.05 * abs(p):
        count.add(row, scene, abs(p - answer) <= math.hypot(interval[p > answer] - answer, noise))


def analyzed(count, scene, truth):
    for j in each("analyze", scene, "--accuracy", ACCURACY, "--runs", 0, "--paths", 1):
        count.next_pool()
        runs = j["gate_runs"]
        endings_of(count, "analyze", scene, j["endings"], j["endings_95"], truth, runs)
        for cost, key in zip(COSTS, ("seconds", None, "work_J", "random_work_J", "lost_J")):
            if key:
                mean_of(count, f"analyze: mean {cost}", scene, j[f"expected_{key}"], j[f"expected_{key}_95"],
                        truth["costs"]["all"][cost])
        for e, own in j["by_ending"].items():
            if e == "all" or not truth["costs"].get(e) or own.get("mean_time_s") is None:
                continue
            rare = " (rare)" if truth["endings"][e] * runs < 100 else ""
            for cost in COSTS:
                mean_of(count, f"analyze: mean {cost} of an ending{rare}", scene, own[f"mean_{cost}"],
                        own[f"mean_{cost}_95"], truth["costs"][e][cost])


def validated(count, scene, truth):
    start = ("--start", "0,0,15") if scene in "ABC" else ()
    for j in each("validate", scene, "--accuracy", ACCURACY, "--trials", VALIDATE_TRIALS, "--null-draws", 199, *start):
        count.next_pool()
        own = j["starts"][0]
        for kind, key, n in (("trials", "dynamics", VALIDATE_TRIALS), ("walks", "walks", VALIDATE_TRIALS),
                             ("chain", "exact", j["matrix"]["gate_runs"])):
            of_shares = 1 if key == "exact" else VALIDATE_TRIALS
            shares = {e: x / of_shares for e, x in own["endings"][key].items()}
            intervals = {e: [x / of_shares for x in interval] for e, interval in own["endings"][f"{key}_95"].items()}
            # Walks are of this chain: their truth is what it says exactly.
            of = {"endings": own["endings"]["exact"]} if key == "walks" else truth
            endings_of(count, f"validate, {kind}", scene, shares, intervals, of, n)
        count.add("validate: right chain not doubted (level 5 %)", scene, own["trials_and_matrix"]["p"] > 0.05)


def powered(count, scene, truth):
    """Its intervals are those of predict, number by number, which is all that is looked at."""
    for seed in seeds_of("power"):
        count.next_pool()
        power, predict = (run(c, *SCENES[scene], "--accuracy", ACCURACY, "--seed", seed) for c in ("power", "predict"))
        count.add("power: as predict's to the last bit", scene, power["endings_95"] == predict["endings_95"])


def rare(count, scene, truth):
    for j in each("rare", scene, "--row", RARE_ROW, "--gate-runs", RARE_RUNS):
        count.next_pool()
        for row, p in zip(j["rows"], truth["rows"]):
            count.share("rare: the chance of a row", scene, p, row["probability"], row["probability_95"],
                        j["split_trials"], MORE_TRUTH_TRIALS)


def built(count, scene, truth):
    with tempfile.TemporaryDirectory() as folder:
        def one(seed):
            matrix = Path(folder) / f"{seed}.nc"
            said = run("build", *SCENES[scene], "--accuracy", ACCURACY, "--seed", seed, "-o", matrix)
            answer = run("predict", matrix)
            matrix.unlink()
            return said, answer
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for said, answer in pool.map(one, seeds_of("build")):
                count.next_pool()
                count.add("build: total variation", scene, tv(flat(answer["final_gates"]), truth["final_gates"]) <=
                          math.hypot(said["state_space"]["error_95"][0], noise_tv(truth["final_gates"], TRUTH_TRIALS)))


def recorded(count, scene, truth):
    """Passages of some bodies, as an observer would have written them down; the method is not told."""
    def one(seed):
        with tempfile.TemporaryDirectory() as folder:
            runs, cell, matrix = (Path(folder) / name for name in ("runs.csv", "cell.toml", "m.nc"))
            run("lattice", *SCENES[scene], "--trials", RECORDED_BODIES, "--seed", seed, "--passages", runs,
                "--cell-file", cell)
            run("build", runs, "--cell", cell, "-o", matrix)
            return run("predict", matrix)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for j in pool.map(one, seeds_of("recorded")):
            of_chain(count, "recorded", scene, j, truth, RECORDED_BODIES, TRUTH_TRIALS)


def imported(count, scene, truth):
    """Counts drawn from a known chain, that of the scene's bins, whose own answer is the truth."""
    if scene not in "ABC":
        return
    with tempfile.TemporaryDirectory() as folder:
        path = lambda name: Path(folder) / name
        run("build", *SCENES[scene], "--bins", "paper", "--trials", 1000, "-o", path("bins.nc"))
        run("export", path("bins.nc"), "--gate", "-o", path("known.csv"))
        rows = defaultdict(list)
        with open(path("known.csv"), newline="") as file:
            for r in csv.DictReader(file):
                rows[r["from"]].append((r["to"], float(r["probability"])))

        def imported_as(name, lines):
            with open(path(f"{name}.csv"), "w", newline="") as file:
                csv.writer(file).writerows(lines)
            run("import", path(f"{name}.csv"), "--states", path("known.states.csv"), "--start",
                STRAIGHT_UP, "--set", "field.columns=9", "--set", "field.rows=9", "--set", "field.max_gates=15",
                "-o", path(f"{name}.nc"))
            return run("predict", path(f"{name}.nc"))

        known = imported_as("exact", [("from", "to", "probability"), *((i, to, p) for i, of in rows.items()
                                                                       for to, p in of)])
        truth = {"endings": known["endings"], "final_gates": flat(known["final_gates"])}

        def one(seed):
            draw = random.Random(f"{scene} {seed}")
            lines = [("from", "to", "count")]
            for i, of in rows.items():
                drawn = draw.choices([to for to, _ in of], [p for _, p in of], k=IMPORTED_RUNS)
                lines += [(i, to, drawn.count(to)) for to in sorted(set(drawn))]
            return imported_as(seed, lines)
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for j in pool.map(one, seeds_of("imported")):
                of_chain(count, "imported", scene, j, truth, IMPORTED_RUNS * len(rows), math.inf)


def of_chain(count, what, scene, j, truth, trials, truth_trials):
    """Total variation, endings and gates of a prediction, or of a chain with replicates of its matrix."""
    count.next_pool()
    bar = j["error_95"] if "error_95" in j else j["matrix_sampling"]["total_variation_q95"]
    count.add(f"{what}: total variation", scene, tv(flat(j["final_gates"]), truth["final_gates"]) <=
              math.hypot(bar, noise_tv(truth["final_gates"], truth_trials)))
    for e, interval in j["endings_95"].items():
        count.share(f"{what}: {e}", scene, truth["endings"][e], j["endings"][e], interval, trials, truth_trials)
    if "final_gates_95" in j:
        gates_of(count, what, scene, j, truth["final_gates"], trials, truth_trials)


def each(command, scene, *options):
    def one(seed):
        return run(command, *SCENES[scene], *options, "--seed", seed)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        yield from pool.map(one, seeds_of(command))


ALSO_LEGS = ("predict", "lattice", "build", "recorded")  # commands whose intervals are counted with LEGS too
COMMANDS = {"predict": predicted, "lattice": simulated, "analyze": analyzed, "validate": validated, "power": powered,
            "rare": rare, "build": built, "recorded": recorded, "imported": imported, "unseen": None}


def main():
    with tempfile.TemporaryDirectory() as folder:
        own = list(SCENES)
        make_legs(Path(folder))
        measure(own, sys.argv[3:] or list(COMMANDS))


def is_made_by(commands, row):
    """Whether one of these commands makes this row: rows that it no longer makes must go."""
    what = "unseen" if row.startswith("predict, unseen") else row.replace(",", ":").split(":")[0]
    return what in commands


def measure(own, commands):
    names = [*SCENES, "M", "R"]
    heads = ["interval", "program", "pools", "answers", "holds_percent", "low_99_percent", "high_99_percent", "verdict",
             "below_in", *(f"{s}_percent" for s in names)]
    table_path = OUT / "coverage.csv"
    kept = []
    if table_path.exists() and set(commands) != set(COMMANDS):
        with open(table_path, newline="") as file:
            table = csv.DictReader(file)
            if table.fieldnames != heads:
                sys.exit(f"{table_path} has other columns: make it anew with all commands")
            kept = [r for r in table if not is_made_by(commands, r["interval"])]
    path = OUT / "truth.json"
    truths = json.loads(path.read_text()) if path.exists() else {}
    for scene in SCENES:
        if scene not in truths:
            truths[scene] = truth_of(scene)
    lacking = [scene for scene in own if "rows" not in truths[scene]]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for scene, more in zip(lacking, pool.map(more_truth_of, lacking)):
            truths[scene].update(more)
    truths_of_starts = unseen_truths(truths)
    path.write_text(json.dumps(truths))
    count = Count()
    for command in commands:
        if command == "unseen":
            unseen(count, truths_of_starts)
        else:
            for scene in SCENES if command in ALSO_LEGS else own:
                COMMANDS[command](count, scene, truths[scene])
    said = subprocess.run([sys.argv[1], "--version"], capture_output=True, text=True, check=True).stdout
    version = said.split("(")[1][:8]
    rows = {row: [row, version, *count.line(row, names)] for row in {row for row, _ in count.of}}
    rows = {r["interval"]: [r[head] for head in heads] for r in kept} | rows
    with open(table_path, "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(heads)
        table.writerows(rows[row] for row in sorted(rows))


if __name__ == "__main__":
    main()
