#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How accurate chains of trees are, at what cost, and whether their error bars hold.

study.py GATEWALK DIR [SCENE...]: writes points.csv and summary.txt into DIR; points of scenes that are
not named stay (-: of all, the summary is made again). One thread; method moreau, whose runs are the
cheapest, so that chains and bars weigh the most. Truth: the final gates of many full trials of other seeds,
whose noise is taken out of errors in squares; truth.json in DIR keeps them, and those that it lacks are run
(another half an hour for all).
"""
import csv, json, math, random, subprocess, sys, tempfile, time
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

GATEWALK, OUT = sys.argv[1], Path(sys.argv[2])
ROOT = Path(__file__).resolve().parents[2]
FIELD = [str(ROOT / "scenes/field.toml"), "--set", "run.method=moreau"]
SCENES = {
    "A": FIELD,
    "B": FIELD + ["--set", "forces.propulsion_N=8", "--set", "forces.random_N=10"],
    "C": FIELD + ["--set", "forces.propulsion_N=8.5", "--set", "forces.random_N=25",
                  "--set", "beams.stiffness_left_Nm_per_rad=300",
                  "--set", "beams.stiffness_right_Nm_per_rad=450"],
    "M": FIELD + ["--set", "forces.propulsion_N=9", "--set", "forces.random_N=35",
                  "--set", "beams.stiffness_left_Nm_per_rad=150",
                  "--set", "beams.stiffness_right_Nm_per_rad=800"],
    "R": [str(ROOT / "scenes/robot.toml"), "--set", "run.method=moreau"],
}
# Table IV's starts, and for the robot four of its own size.
FOUR = defaultdict(lambda: [(0, 0, 15), (23, -11, 16), (4, 5, 10), (-17, 13, 12)])
FOUR["R"] = [(0, 0, 0.4), (0.184, -0.15, 0.3), (0.032, 0.07, 0.14), (-0.136, 0.18, 0.2)]
# Of d, v_x, v_y: within --starts all.
RANGES = defaultdict(lambda: ((-24, 24), (-20, 20), (10, 20)))
RANGES["R"] = ((-0.192, 0.192), (-0.28, 0.28), (0.142, 0.4))


def anywhere(scene, seed, count):
    """Starts in the range of --starts all."""
    own = random.Random(seed)
    return [tuple(round(own.uniform(*r), 3) for r in RANGES[scene]) for _ in range(count)]


def hundred(scene):
    return anywhere(scene, 5, 8) + anywhere(scene, 77, 92)


KNOWN = 24  # of the hundred whose truth is known
# Trials of the truth by seed, seeds of predictions of one start by accuracy, and chains for any
# start: accuracy of the build, starts predicted, seeds.
PLAN = defaultdict(lambda: dict(
    one=[(9001, 500_000), (9002, 500_000)], many=[(9003, 150_000)],
    seeds={0.04: 24, 0.02: 12, 0.01: 4},
    builds=[(0.06, 100, 2), (0.03, 100, 1), (0.02, KNOWN, 1), (0.06, KNOWN, 6)]))
for s in "MR":  # looked at less
    PLAN[s] = dict(one=[(9001, 100_000)], many=[(9003, 40_000)], seeds={0.04: 12, 0.02: 6},
                   builds=[(0.06, KNOWN, 6)])


def run(*words):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.json"
        subprocess.run([GATEWALK, *map(str, words), "--json", out, "--threads", "1", "--quiet"],
                       check=True, stdout=subprocess.DEVNULL)
        return json.loads(out.read_text())


def flat(grid):
    return [x for row in grid for x in row]


def tv(p, q):
    return 0.5 * sum(abs(a - b) for a, b in zip(p, q))


def expected_tv(p, trials):
    """Of the shares of so many trials, each share nearly normal."""
    return 0.5 * sum(math.sqrt(2 * x * (1 - x) / (math.pi * trials)) for x in p)


class Truth:
    def __init__(self, scene, start, kind):
        key = f"{scene} {','.join(map(str, start))} {kind}"
        if key not in TRUTHS:
            d, vx, vy = start
            made = {"trials": 0, "gates": 0, "final_gates": [0] * 81}
            for seed, trials in PLAN[scene][kind]:
                j = run("lattice", *SCENES[scene], "--set", f"start.x_m={d}", "--set",
                        f"start.vx_m_per_s={vx}", "--set", f"start.vy_m_per_s={vy}", "--trials",
                        trials, "--seed", seed)
                made["trials"] += trials
                made["gates"] += trials + sum(e["count"] for e in j["entries_between_gates"].values())
                made["final_gates"] = [a + b for a, b in zip(made["final_gates"], flat(j["final_gates"]))]
            TRUTHS[key] = made
        t = TRUTHS[key]
        self.p = [n / t["trials"] for n in t["final_gates"]]
        self.noise = expected_tv(self.p, t["trials"])
        self.gates = t["gates"] / t["trials"]

    def error(self, p):
        return tv(p, self.p)

    def clean(self, mean_error):
        return math.sqrt(max(1e-12, mean_error ** 2 - self.noise ** 2))

    def gate_runs_for(self, error):
        return self.gates * (expected_tv(self.p, 1) / error) ** 2


def one_start(scene, k):
    """Predictions straight from the scene, and the paper's chain."""
    truth = Truth(scene, FOUR[scene][k], "one")
    start = ",".join(map(str, FOUR[scene][k]))
    rows = []
    for accuracy, seeds in PLAN[scene]["seeds"].items():
        for seed in range(1, seeds + 1):
            j = run("predict", *SCENES[scene], "--start", start, "--accuracy", accuracy, "--seed",
                    seed)
            a = j["starts"][0]
            rows.append(dict(kind="tree", scene=scene, start=start, accuracy=accuracy, seed=seed,
                             error=truth.error(flat(a["final_gates"])), error_95=a["error_95"],
                             gate_runs=j["gate_runs"], seconds=j["seconds"],
                             run_seconds=j["run_seconds"], answer=a["answer_from"], truth=truth))
    for trials in (10, 100, 1000) if scene in "ABC" else ():  # the robot's starts lie outside its bins
        with tempfile.TemporaryDirectory() as folder:
            matrix = Path(folder) / "m.nc"
            watch = time.time()
            run("build", *SCENES[scene], "--bins", "paper", "--trials", trials, "-o", matrix)
            j = run("predict", matrix, "--start", start)
            rows.append(dict(kind="paper", scene=scene, start=start, accuracy=trials, seed=1,
                             error=truth.error(flat(j["starts"][0]["final_gates"])),
                             error_95=float("nan"), gate_runs=87 * trials,
                             seconds=time.time() - watch, run_seconds=float("nan"),
                             answer="chain", truth=truth))
    return rows


def any_start(scene, accuracy, count, seed):
    """One chain for a range of starts; predictions from starts that it does not know."""
    starts = hundred(scene)[:count]
    truths = [Truth(scene, s, "many") for s in starts[:KNOWN]]
    with tempfile.TemporaryDirectory() as folder:
        matrix = Path(folder) / "m.nc"
        watch = time.time()
        made = run("build", *SCENES[scene], "--accuracy", accuracy, "--starts", "all", "--seed", seed,
                   "-o", matrix)
        build_seconds = time.time() - watch
        words = [w for s in starts for w in ("--start", ",".join(map(str, s)))]
        j = run("predict", matrix, *words, "--seed", seed)
    rows = []
    for truth, a, s in zip(truths, j["starts"], starts):
        rows.append(dict(kind=f"any {count}", scene=scene, start=",".join(map(str, s)),
                         accuracy=accuracy, seed=seed, error=truth.error(flat(a["final_gates"])),
                         error_95=a["error_95"], gate_runs=j["gate_runs"] / count,
                         seconds=j["seconds"] / count, run_seconds=j["run_seconds"] / count,
                         answer=a["answer_from"], truth=truth, build_seconds=build_seconds,
                         build_runs=made["state_space"]["gate_runs"]))
    return rows


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def geometric(values):
    return math.exp(mean(math.log(v) for v in values))


def covered(rows):
    """Of error bars, the truth's own noise allowed for."""
    return mean(r["error"] <= math.hypot(r["error_95"], r["truth"].noise) for r in rows)


def seconds_per_run(methods):
    """Of the dynamics alone, one thread: the least of five runs by turns."""
    def one(method):
        j = run("predict", *FIELD, "--set", f"run.method={method}", "--gate-runs", 20000, "--accuracy", 0.0001)
        return j["run_seconds"] / j["gate_runs"]

    return {m: min(times) for m, times in zip(methods, zip(*([one(m) for m in methods] for _ in range(5))))}


def beside_runs(r, cost):
    """Seconds of chains and bars, as if its runs had taken what they take on an idle machine."""
    return (r["seconds"] - r["run_seconds"]) * cost["moreau"] * r["gate_runs"] / r["run_seconds"]


def summary(rows):
    cost = seconds_per_run(("moreau", "stable"))
    lines = [f"a gate run takes {1e6 * cost['moreau']:.1f} us by moreau, "
             f"{1e6 * cost['stable']:.1f} us by stable (one thread)", "",
             "ONE START. cost ratio: of direct simulation over that of the chain, everything",
             "counted, at the same mean error; in brackets with the runs of method stable.",
             "scene start          asked  error   bar     gate runs  seconds  cost ratio"]
    groups = defaultdict(list)
    for r in rows:
        groups[r["kind"], r["scene"], r["start"], r["accuracy"]].append(r)
    ratios = defaultdict(list)
    for (kind, scene, start, accuracy), g in groups.items():
        if kind != "tree":
            continue
        error = g[0]["truth"].clean(mean(r["error"] for r in g))
        direct = g[0]["truth"].gate_runs_for(error)
        runs, beside = mean(r["gate_runs"] for r in g), mean(beside_runs(r, cost) for r in g)
        ratio = {m: direct * c / (runs * c + beside) for m, c in cost.items()}
        for m in cost:
            ratios[scene, accuracy, m].append(ratio[m])
        lines.append(f"{scene}     {start:13s}  {accuracy:5.2f}  {error:.4f}  "
                     f"{mean(r['error_95'] for r in g):.4f}  {runs:9.0f}  "
                     f"{mean(r['seconds'] for r in g):7.2f}  {ratio['moreau']:5.1f} "
                     f"({ratio['stable']:.1f})")
    for scene in SCENES:
        for accuracy in PLAN[scene]["seeds"]:
            if not ratios[scene, accuracy, "moreau"]:
                continue
            lines.append(f"{scene} asked {accuracy}: geometric mean {geometric(ratios[scene, accuracy, 'moreau']):.1f} "
                         f"({geometric(ratios[scene, accuracy, 'stable']):.1f}), least "
                         f"{min(ratios[scene, accuracy, 'moreau']):.1f} ({min(ratios[scene, accuracy, 'stable']):.1f})")
    lines += ["", "ERROR AGAINST GATE RUNS, one start. slope: of the logarithms, by least squares, each start with a",
              "height of its own (direct simulation: -0.5); then gate runs and errors by accuracy asked, means over",
              "starts, and the gate runs of direct simulation for these errors"]
    for scene in SCENES:
        points = {}  # start, accuracy: log runs, log error, log runs of direct simulation
        for (kind, s, start, accuracy), g in groups.items():
            if kind == "tree" and s == scene:
                error = g[0]["truth"].clean(mean(r["error"] for r in g))
                points[start, accuracy] = [math.log(x) for x in (
                    mean(r["gate_runs"] for r in g), error, g[0]["truth"].gate_runs_for(error))]
        if not points:
            continue
        starts = {start for start, _ in points}
        centre = {s: [mean(p[i] for (start, _), p in points.items() if start == s) for i in (0, 1)] for s in starts}
        off = [[p[i] - centre[start][i] for i in (0, 1)] for (start, _), p in points.items()]
        slope = sum(x * y for x, y in off) / sum(x * x for x, _ in off)
        by = [[math.exp(mean(points[s, a][i] for s in starts)) for i in range(3)] for a in PLAN[scene]["seeds"]]
        lines.append(f"{scene}: slope {slope:.2f}; " + ", ".join(f"{n:.0f} {e:.4f} {d:.0f}" for n, e, d in by))
    tree = [r for r in rows if r["kind"] == "tree"]
    lines += ["", f"error bars hold in {100 * covered(tree):.1f} % of {len(tree)} answers, by accuracy: " + ", ".join(
        f"{a}: {100 * covered([r for r in tree if r['accuracy'] == a]):.1f} %" for a in PLAN["A"]["seeds"])]
    lines += ["", "ANY START: build --accuracy ... --starts all, predictions from starts that the chain does not",
              "know. Cost ratio: of direct simulation over one build and a hundred predictions, everything",
              "counted, at the same mean error; in brackets with the runs of method stable.",
              "scene asked  error   largest  build runs, s    a start's runs, s   "
              "cost ratio (of %d starts: 0.02)" % KNOWN]
    for scene in SCENES:
        for accuracy, count, _ in PLAN[scene]["builds"]:
            if (accuracy, count) == (0.06, KNOWN):
                continue
            g = [r for r in rows if r["kind"] == f"any {count}" and r["scene"] == scene and
                 r["accuracy"] == accuracy]
            if not g:
                continue
            errors = [r["truth"].clean(r["error"]) for r in g]
            direct = mean(r["truth"].gate_runs_for(mean(errors)) for r in g)
            build_runs, build = mean(r["build_runs"] for r in g), mean(r["build_seconds"] for r in g)
            runs, beside = mean(r["gate_runs"] for r in g), mean(beside_runs(r, cost) for r in g)
            ratio = {}
            for m, c in cost.items():
                made = build + build_runs * (c - cost["moreau"])
                ratio[m] = count * direct * c / (made + count * (runs * c + beside))
            lines.append(f"{scene}     {accuracy:.2f}   {mean(errors):.4f}  {max(errors):.4f}   "
                         f"{build_runs:8.0f} {build:6.1f}  {runs:8.0f} {mean(r['seconds'] for r in g):6.3f}  "
                         f"{ratio['moreau']:9.1f} ({ratio['stable']:.1f})")
    unseen = [r for r in rows if r["kind"].startswith("any")]
    lines.append(f"error bars of starts unseen in building hold in {100 * covered(unseen):.1f} % of "
                 f"{len(unseen)} answers, by scene: " + ", ".join(
                     f"{s}: {100 * covered([r for r in unseen if r['scene'] == s]):.1f} %"
                     for s in SCENES if any(r["scene"] == s for r in unseen)))
    lines += ["", "THE PAPER'S CHAIN (87 bins), errors by runs per state, mean over the four starts"]
    for scene in "ABC":
        g = [r for r in rows if r["kind"] == "paper" and r["scene"] == scene]
        if not g:
            continue
        lines.append(f"{scene}: " + ", ".join(
            f"{n}: {mean(r['truth'].clean(r['error']) for r in g if r['accuracy'] == n):.3f}"
            for n in (10, 100, 1000)))
    return "\n".join(lines) + "\n"


TRUTHS = {}


KEYS = ["kind", "scene", "start", "accuracy", "seed", "error", "error_95", "gate_runs", "seconds",
        "run_seconds", "answer", "build_seconds", "build_runs"]


def kept_rows(scenes):
    """Those of the other scenes, from an earlier call."""
    if not (OUT / "points.csv").exists():
        return []
    rows = [r for r in csv.DictReader((OUT / "points.csv").open()) if r["scene"] not in scenes]
    for r in rows:
        for key in KEYS[3:10] + KEYS[11:]:
            r[key] = float(r[key]) if r[key] else None
        start = tuple(json.loads(f"[{r['start']}]"))
        r["truth"] = Truth(r["scene"], start, "many" if r["kind"].startswith("any") else "one")
    return rows


def main():
    OUT.mkdir(parents=True, exist_ok=True)
    scenes = [] if sys.argv[3:] == ["-"] else sys.argv[3:] or list(SCENES)
    kept = OUT / "truth.json"
    if kept.exists():
        TRUTHS.update(json.loads(kept.read_text()))
    with ThreadPoolExecutor(2) as pool:
        jobs = [pool.submit(Truth, s, start, "one") for s in scenes for start in FOUR[s]]
        jobs += [pool.submit(Truth, s, start, "many") for s in scenes for start in hundred(s)[:KNOWN]]
        for job in jobs:
            job.result()
        kept.write_text(json.dumps(TRUTHS, indent=0, sort_keys=True) + "\n")
        jobs = [pool.submit(any_start, s, accuracy, count, seed) for s in scenes
                for accuracy, count, seeds in PLAN[s]["builds"] for seed in range(1, seeds + 1)]
        jobs += [pool.submit(one_start, s, k) for s in scenes for k in range(len(FOUR[s]))]
        rows = kept_rows(scenes) + [row for job in jobs for row in job.result()]
    with open(OUT / "points.csv", "w", newline="") as file:
        table = csv.DictWriter(file, KEYS, extrasaction="ignore")
        table.writeheader()
        table.writerows(rows)
    (OUT / "summary.txt").write_text(summary(rows))


if __name__ == "__main__":
    main()
