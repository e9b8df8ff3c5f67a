#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What more threads, ranks, parts and checkpoints cost and save: scaling.py GATEWALK GATEWALK_MPI SCENE DIR

Writes DIR/runs.csv (a line per run: what, seconds of wall and of CPU, peak memory in MB) and DIR/summary.txt. Runs that
are compared take turns; figures are medians, with the smallest and largest.
"""
import csv, os, statistics, subprocess, sys, tempfile, time
from pathlib import Path

gatewalk, with_mpi, scene, folder = sys.argv[1:5]
ROUNDS = 7
TRIALS = 40_000
os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
rows = []


def run(what, words, where):
    begin = time.monotonic()
    process = subprocess.Popen([str(w) for w in words], cwd=where, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = 0
    if status != 0:
        raise SystemExit(f"failed: {words}")
    rows.append([what, round(time.monotonic() - begin, 3), round(usage.ru_utime + usage.ru_stime, 3),
                 round(usage.ru_maxrss / 1024, 1)])


def field(trials, *more):
    return ["lattice", scene, "--trials", trials, "--json", "out.json", "--quiet", "--force", *more]


with tempfile.TemporaryDirectory() as where:
    one = ["--threads", 1]
    for _ in range(ROUNDS):
        run("1 thread", [gatewalk, *field(TRIALS), *one], where)
        run("1 thread, checkpoint", [gatewalk, *field(TRIALS), *one, "--checkpoint", "pieces"], where)
        run("2 threads", [gatewalk, *field(TRIALS), "--threads", 2], where)
        for ranks in range(1, 5):
            run(f"{ranks} ranks", ["mpirun", "-n", ranks, "--oversubscribe", with_mpi, *field(TRIALS), *one], where)
        for parts in 8, 100:
            for f in Path(where).glob("part*"):
                f.unlink()
            begin, before = time.monotonic(), len(rows)
            for i in range(1, parts + 1):
                run("part", [gatewalk, *field(TRIALS), *one, "--shard", f"{i}/{parts}", "--part", f"part{i}"], where)
            sums = [round(sum(r[k] for r in rows[before:]), 3) for k in (1, 2)]
            memory = max(r[3] for r in rows[before:])
            del rows[before:]
            rows.append([f"{parts} parts, one after the other", *sums, memory])
            run(f"merge of {parts} parts", [gatewalk, "merge", *(f"part{i}" for i in range(1, parts + 1)), "--quiet", "--force"], where)
            rows[-1].append(sum(f.stat().st_size for f in Path(where).glob("part*")) / 2**20)
        run("a run of 100 trials", [gatewalk, *field(100), *one], where)
        run("a prediction, 0.01, 1 thread", [gatewalk, "predict", scene, "--accuracy", 0.01, "--json", "p.json", "--quiet", "--force", *one], where)
        run("a prediction, 0.01, checkpoint", [gatewalk, "predict", scene, "--accuracy", 0.01, "--json", "p.json", "--quiet", "--force", *one, "--checkpoint", "pieces"], where)
        run("a prediction, 0.01, 2 threads", [gatewalk, "predict", scene, "--accuracy", 0.01, "--json", "p.json", "--quiet", "--force", "--threads", 2], where)
        run("a prediction, 0.01, 2 ranks", ["mpirun", "-n", 2, "--oversubscribe", with_mpi, "predict", scene, "--accuracy", 0.01, "--json", "p.json", "--quiet", "--force", *one], where)

with open(Path(folder) / "runs.csv", "w", newline="") as file:
    table = csv.writer(file, lineterminator="\n")
    table.writerow(["what", "wall_s", "cpu_s", "peak_MB", "parts_MB"])
    table.writerows(rows)

lines = [f"lattice of {TRIALS} trials, and predictions; {ROUNDS} rounds in which all take turns: median [smallest, largest]",
         "what | wall, s | CPU, s | peak memory, MB"]
names = list(dict.fromkeys(r[0] for r in rows))
of = {name: [r for r in rows if r[0] == name] for name in names}
for name in names:
    def shown(k):
        v = [r[k] for r in of[name]]
        return f"{statistics.median(v):.2f} [{min(v):.2f}, {max(v):.2f}]"
    size = f" | {of[name][0][4]:.1f} MB in the parts" if len(of[name][0]) > 4 else ""
    lines.append(f"{name} | {shown(1)} | {shown(2)} | {max(r[3] for r in of[name]):.0f}{size}")


def ratio(a, b, k):
    return statistics.median(x[k] / y[k] for x, y in zip(of[a], of[b]))


lines += ["", "ratios, median of those of each round",
          f"checkpoint: {ratio('1 thread, checkpoint', '1 thread', 1):.4f} of the wall time, {ratio('1 thread, checkpoint', '1 thread', 2):.4f} of the CPU time; "
          f"of a prediction {ratio('a prediction, 0.01, checkpoint', 'a prediction, 0.01, 1 thread', 1):.4f} and {ratio('a prediction, 0.01, checkpoint', 'a prediction, 0.01, 1 thread', 2):.4f}",
          f"2 threads: {1 / ratio('2 threads', '1 thread', 1):.2f} times as fast; 2 ranks: {1 / ratio('2 ranks', '1 thread', 1):.2f}"]
for parts in 8, 100:
    over = [(p[1] - s[1]) / parts for p, s in zip(of[f"{parts} parts, one after the other"], of["1 thread"])]
    lines.append(f"a part of {parts}: {1e3 * statistics.median(over):.0f} ms beyond its share of the run; "
                 f"merge: {statistics.median(r[1] for r in of[f'merge of {parts} parts']):.2f} s")
(Path(folder) / "summary.txt").write_text("\n".join(lines) + "\n")
print("\n".join(lines))
