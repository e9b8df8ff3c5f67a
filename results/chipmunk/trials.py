#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Direct trials from each of the starts: trials.py GATEWALK PROGRAM DIR LAYERS

Adds lines to DIR/direct.csv, a line per start and layer of 100 trials: counts of endings and of final
gates, seconds of CPU of gatewalk and program together. Lines that are there are not run again.
"""
import csv, json, os, subprocess, sys, tempfile, threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from common import ENDINGS, GATES, LAYER, STARTS, cpu_of, key_of

gatewalk, program, folder, layers = sys.argv[1], sys.argv[2], Path(sys.argv[3]), int(sys.argv[4])
table = folder / "direct.csv"
done = set()
if table.exists():
    done = {(r["start"], r["seed"]) for r in csv.DictReader(table.open())}
else:
    table.write_text(",".join(["start", "seed", "trials", *ENDINGS, *GATES, "cpu_s"]) + "\n")
lock = threading.Lock()


def run(job):
    layer, k = job
    seed = 1000 * layer + k
    start = STARTS[k]
    if (key_of(start), str(seed)) in done:
        return
    with tempfile.TemporaryDirectory() as where:
        out = Path(where) / "out.json"
        words = [w for key, x in zip(("d_m", "vx_m_per_s", "vy_m_per_s"), start)
                 for w in ("--set", f"start.{key}={x}")]
        cpu = cpu_of([gatewalk, "lattice", folder / "cell.toml", "--cell-program", program, *words,
                      "--trials", LAYER, "--seed", seed, "--json", out, "--threads", 1, "--quiet"])
        j = json.loads(out.read_text())
    gates = [n for row in j["final_gates"] for n in row]
    with lock, table.open("a") as file:
        file.write(",".join(map(str, [key_of(start), seed, j["trials"], *(j["endings"][e] for e in ENDINGS),
                                      *gates, round(cpu, 3)])) + "\n")


with ThreadPoolExecutor(2) as pool:
    list(pool.map(run, [(layer, k) for layer in range(1, layers + 1) for k in range(len(STARTS))]))
lines = table.read_text().splitlines()
table.write_text("\n".join([lines[0], *sorted(lines[1:], key=lambda line: int(line.split(",")[1]))]) + "\n")
