#!/usr/bin/env python3
"""How accurate chains of trees are, at what cost, and whether their error bars hold.

study.py GATEWALK DIR: writes points.csv and summary.txt into DIR. One thread; method moreau, whose
runs are the cheapest, so that chains and bars weigh the most. Truth: many full trials of another
seed, whose noise is taken out of errors in squares.
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
}
TABLE_IV = [(0, 0, 15), (23, -11, 16), (4, 5, 10), (-17, 13, 12)]
random.seed(5)  # anywhere in the range of --starts all
ANYWHERE = [(round(random.uniform(-24, 24), 3), round(random.uniform(-20, 20), 3),
             round(random.uniform(10, 20), 3)) for _ in range(8)]
TRUTH = {"one": 1_000_000, "many": 200_000}
SEEDS = {0.04: 40, 0.02: 24, 0.01: 8}
BUILDS = 5  # chains for any start, per scene


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
    def __init__(self, scene, start, trials):
        d, vx, vy = start
        j = run("lattice", *SCENES[scene], "--set", f"start.x_m={d}", "--set",
                f"start.vx_m_per_s={vx}", "--set", f"start.vy_m_per_s={vy}", "--trials", trials,
                "--seed", 9001)
        self.p = [n / trials for n in flat(j["final_gates"])]
        self.noise = expected_tv(self.p, trials)
        self.gates = 1 + sum(e["count"] for e in j["entries_between_gates"].values()) / trials

    def error(self, p):
        return tv(p, self.p)

    def clean(self, mean_error):
        return math.sqrt(max(1e-12, mean_error ** 2 - self.noise ** 2))

    def gate_runs_for(self, error):
        return self.gates * (expected_tv(self.p, 1) / error) ** 2


def one_start(scene, k):
    """Predictions straight from the scene, and the paper's chain."""
    truth = Truth(scene, TABLE_IV[k], TRUTH["one"])
    start = ",".join(map(str, TABLE_IV[k]))
    rows = []
    for accuracy, seeds in SEEDS.items():
        for seed in range(1, seeds + 1):
            j = run("predict", *SCENES[scene], "--start", start, "--accuracy", accuracy, "--seed",
                    seed)
            a = j["starts"][0]
            rows.append(dict(kind="tree", scene=scene, start=start, accuracy=accuracy, seed=seed,
                             error=truth.error(flat(a["final_gates"])), error_95=a["error_95"],
                             gate_runs=j["gate_runs"], seconds=j["seconds"],
                             run_seconds=j["run_seconds"], answer=a["answer_from"], truth=truth))
    for trials in (10, 100, 1000):
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


def any_start(scene):
    """One chain for a range of starts; predictions from starts that it does not know."""
    truths = [Truth(scene, s, TRUTH["many"]) for s in ANYWHERE]
    rows = []
    for seed in range(1, BUILDS + 1):
        with tempfile.TemporaryDirectory() as folder:
            matrix = Path(folder) / "m.nc"
            watch = time.time()
            made = run("build", *SCENES[scene], "--accuracy", 0.02, "--starts", "all", "--seed",
                       seed, "-o", matrix)
            seconds = time.time() - watch
            words = [w for s in ANYWHERE for w in ("--start", ",".join(map(str, s)))]
            j = run("predict", matrix, *words, "--seed", seed)
        for truth, a, s in zip(truths, j["starts"], ANYWHERE):
            rows.append(dict(kind="many", scene=scene, start=",".join(map(str, s)), accuracy=0.02,
                             seed=seed, error=truth.error(flat(a["final_gates"])),
                             error_95=a["error_95"], gate_runs=j["gate_runs"] / len(ANYWHERE),
                             seconds=j["seconds"] / len(ANYWHERE),
                             run_seconds=j["run_seconds"] / len(ANYWHERE),
                             answer=a["answer_from"], truth=truth, build_seconds=seconds,
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


def seconds_per_run(method):
    """Of the dynamics alone, one thread."""
    j = run("predict", *FIELD, "--set", f"run.method={method}", "--gate-runs", 20000, "--accuracy",
            0.0001)
    return j["run_seconds"] / j["gate_runs"]


def beside_runs(r, cost):
    """Seconds of chains and bars, as if its runs had taken what they take on an idle machine."""
    return (r["seconds"] - r["run_seconds"]) * cost["moreau"] * r["gate_runs"] / r["run_seconds"]


def summary(rows):
    cost = {m: seconds_per_run(m) for m in ("moreau", "stable")}
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
        for accuracy in SEEDS:
            lines.append(f"{scene} asked {accuracy}: geometric mean {geometric(ratios[scene, accuracy, 'moreau']):.1f} "
                         f"({geometric(ratios[scene, accuracy, 'stable']):.1f}), least "
                         f"{min(ratios[scene, accuracy, 'moreau']):.1f} ({min(ratios[scene, accuracy, 'stable']):.1f})")
    tree = [r for r in rows if r["kind"] == "tree"]
    lines += ["", f"error bars hold in {100 * covered(tree):.1f} % of {len(tree)} answers, by accuracy: " +
              ", ".join(f"{a}: {100 * covered([r for r in tree if r['accuracy'] == a]):.1f} %" for a in SEEDS)]
    lines += ["", "ANY START: build --accuracy 0.02 --starts all, predictions from 8 starts that it does",
              "not know. For a hundred starts: one build and a hundred times the mean of these."]
    for scene in SCENES:
        g = [r for r in rows if r["kind"] == "many" and r["scene"] == scene]
        errors = [r["truth"].clean(r["error"]) for r in g]
        direct = mean(r["truth"].gate_runs_for(mean(errors)) for r in g)
        build_runs, build = mean(r["build_runs"] for r in g), mean(r["build_seconds"] for r in g)
        runs, beside = mean(r["gate_runs"] for r in g), mean(beside_runs(r, cost) for r in g)
        ratio = {}
        for m, c in cost.items():
            made = build + build_runs * (c - cost["moreau"])
            ratio[m] = 100 * direct * c / (made + 100 * (runs * c + beside))
        lines.append(f"{scene}: error mean {mean(errors):.4f}, largest {max(errors):.4f}; built in "
                     f"{build:.1f} s from {build_runs:.0f} gate runs; a start {mean(r['seconds'] for r in g):.2f} s, "
                     f"{runs:.0f} gate runs; cost ratio for a hundred starts {ratio['moreau']:.1f} "
                     f"({ratio['stable']:.1f}); bars hold in {100 * covered(g):.1f} % of {len(g)}")
    many = [r for r in rows if r["kind"] == "many"]
    lines.append(f"error bars of starts unseen in building hold in {100 * covered(many):.1f} % of {len(many)} answers")
    lines += ["", "THE PAPER'S CHAIN (87 bins), errors by runs per state, mean over the four starts"]
    for scene in SCENES:
        g = [r for r in rows if r["kind"] == "paper" and r["scene"] == scene]
        lines.append(f"{scene}: " + ", ".join(
            f"{n}: {mean(r['truth'].clean(r['error']) for r in g if r['accuracy'] == n):.3f}"
            for n in (10, 100, 1000)))
    return "\n".join(lines) + "\n"


def main():
    OUT.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(2) as pool:
        jobs = [pool.submit(any_start, s) for s in SCENES]
        jobs += [pool.submit(one_start, s, k) for s in SCENES for k in range(len(TABLE_IV))]
        rows = [row for job in jobs for row in job.result()]
    keys = ["kind", "scene", "start", "accuracy", "seed", "error", "error_95", "gate_runs",
            "seconds", "run_seconds", "answer", "build_seconds", "build_runs"]
    with open(OUT / "points.csv", "w", newline="") as file:
        table = csv.DictWriter(file, keys, extrasaction="ignore")
        table.writeheader()
        table.writerows(rows)
    (OUT / "summary.txt").write_text(summary(rows))


main()
