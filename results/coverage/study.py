#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How often 95 % intervals hold the truth: study.py GATEWALK DIR.

Each kind of interval is a row: of predictions from a scene's own start, of predictions from starts that a
chain was not built with, of the full dynamics. Truth: 10^6 full trials of another seed (of unseen starts
150 000 or 40 000, of results/tree), whose own noise is allowed for: added in squares to the half of the
interval on the truth's side, or to the bar. Rare: shares of which fewer than ten trials are expected in
what the answer was made from; an interval of such a share can only say "at most", and should hold more
often.
"""
import csv, importlib.util, json, math, os, sys, tempfile
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
TRUTH_TRIALS, SEEDS, ACCURACY = 1_000_000, 200, 0.04
LATTICE_TRIALS, LATTICE_SEEDS = 1000, 200
UNSEEN = {"A": 10, "B": 6, "C": 10, "R": 10, "M": 6}  # chains of results/tree's scenes, 24 starts each


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


class Count:
    def __init__(self):
        self.held, self.of = defaultdict(int), defaultdict(int)

    def add(self, row, scene, holds):
        for key in ((row, scene), (row, "all")):
            self.of[key] += 1
            self.held[key] += holds

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
    low, high = (flat(j["final_gates_95"][side]) for side in ("low", "high"))
    for p, own, a, b in zip(truth, flat(j["final_gates"]), low, high):
        count.share(f"{what}: a final gate", scene, p, own, (a, b), trials, truth_trials)


def predicted(count, scene, truth):
    def one(seed):
        return run("predict", *SCENES[scene], "--accuracy", ACCURACY, "--seed", seed)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for j in pool.map(one, range(1, SEEDS + 1)):
            trials = j["first_runs"]
            answer, p = flat(j["final_gates"]), truth["final_gates"]
            count.add("predict: total variation", scene, tv(answer, p) <= math.hypot(j["error_95"], noise_tv(p, TRUTH_TRIALS)))
            noise = 100 * math.sqrt(sum(x * (1 - x) for x in p) / TRUTH_TRIALS / len(p))
            count.add("predict: RMSE", scene, rmse(answer, p) <= math.hypot(j["rmse_per_100_95"], noise))
            if j["corrcoef_95"] is not None:
                count.add("predict: corrcoef", scene, corrcoef(answer, p) >= j["corrcoef_95"])
            for e, interval in j["endings_95"].items():
                count.share(f"predict: {e}", scene, truth["endings"][e], j["endings"][e], interval, trials)
            gates_of(count, "predict", scene, j, p, trials)
            for side, places in j["exits"].items():
                for q, place in zip(truth["exits"][side], places):
                    count.share("predict: where they leave", scene, q, place["share"], place["interval_95"], trials)


def simulated(count, scene, truth):
    def one(seed):
        return run("lattice", *SCENES[scene], "--trials", LATTICE_TRIALS, "--seed", seed)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for j in pool.map(one, range(1, LATTICE_SEEDS + 1)):
            for e, interval in j["endings_95"].items():
                count.share(f"lattice: {e}", scene, truth["endings"][e], j["endings"][e] / LATTICE_TRIALS, interval, LATTICE_TRIALS)
            for side, places in j["exits"].items():
                for q, place in zip(truth["exits"][side], places):
                    count.share("lattice: where they leave", scene, q, place["share"], place["interval_95"], LATTICE_TRIALS)


def unseen(count):
    """As results/tree has them, its truth of 150 000 trials (40 000 of M and R)."""
    truths = json.loads((ROOT / "results/tree/truth.json").read_text())

    def one(work):
        scene, seed = work
        starts = tree.hundred(scene)[:tree.KNOWN]
        with tempfile.TemporaryDirectory() as folder:
            matrix = Path(folder) / "m.nc"
            run("build", *tree.SCENES[scene], "--accuracy", 0.06, "--starts", "all", "--seed", seed, "-o", matrix)
            words = [w for s in starts for w in ("--start", ",".join(map(str, s)))]
            return scene, starts, run("predict", matrix, *words, "--seed", seed)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for scene, starts, j in pool.map(one, [(s, seed) for s, n in UNSEEN.items() for seed in range(101, 101 + n)]):
            for s, a in zip(starts, j["starts"]):
                t = truths[f"{scene} {','.join(map(str, s))} many"]
                p = [n / t["trials"] for n in t["final_gates"]]
                answer = flat(a["final_gates"])
                count.add("predict, unseen start: total variation", scene,
                          tv(answer, p) <= math.hypot(a["error_95"], noise_tv(p, t["trials"])))
                noise = 100 * math.sqrt(sum(x * (1 - x) for x in p) / t["trials"] / len(p))
                count.add("predict, unseen start: RMSE", scene, rmse(answer, p) <= math.hypot(a["rmse_per_100_95"], noise))
                gates_of(count, "predict, unseen start", scene, a, p, a["first_runs"], t["trials"])


def main():
    path = OUT / "truth.json"
    truths = json.loads(path.read_text()) if path.exists() else {}
    for scene in SCENES:
        if scene not in truths:
            truths[scene] = truth_of(scene)
            path.write_text(json.dumps(truths))
    count = Count()
    for scene in SCENES:
        predicted(count, scene, truths[scene])
        simulated(count, scene, truths[scene])
    unseen(count)
    names = [*SCENES, "M", "R", "all"]
    with open(OUT / "coverage.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["interval", "answers", *(f"{s}_percent" for s in names)])
        for row in sorted({row for row, _ in count.of}):
            table.writerow([row, count.of[row, "all"],
                            *(f"{100 * count.held[row, s] / count.of[row, s]:.1f}" if count.of[row, s] else "" for s in names)])


if __name__ == "__main__":
    main()
