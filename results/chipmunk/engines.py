#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Both engines without a chain: engines.py GATEWALK PROGRAM DIR SOURCE

Writes DIR/engines.csv, trials through the field from the start of cell.toml, and DIR/gates.csv, how bodies
from there leave their first gate, with bounces or without, and in variants of the program's SOURCE.
"""
import csv, json, subprocess, sys, tempfile
from collections import Counter
from pathlib import Path

from common import ENDINGS, FIELD, GATES, cpu_of

gatewalk, program, folder, source = sys.argv[1], sys.argv[2], Path(sys.argv[3]), Path(sys.argv[4])
FACES = ["EN", "LD", "RD", "LT", "RT", "trapped"]
CHIPMUNK = [folder / "cell.toml", "--cell-program"]
STILL = {"kTipRestitution = 1.0": "kTipRestitution = 0.0"}
# Name, words of the scene, changes to the source, passages.
VARIANTS = [
    ("ours", [FIELD], None, 100_000),
    ("Chipmunk", CHIPMUNK, {}, 6000),
    ("ours, no bounces", [FIELD, "--set", "contact.restitution=0", "--set", "contact.tip_restitution=0"], None, 100_000),
    ("Chipmunk, no bounces", [*CHIPMUNK, "--set", "parameters.restitution=0"], STILL, 6000),
    ("Chipmunk, 0.001 s", CHIPMUNK,
     {"kStep = 0.004": "kStep = 0.001", "kSteps = 3000, kStepsPerHold = 5": "kSteps = 12000, kStepsPerHold = 20"}, 2000),
    ("Chipmunk, 100 iterations", CHIPMUNK,
     {"space_(cpSpaceNew()) {": "space_(cpSpaceNew()) { cpSpaceSetIterations(space_, 100);"}, 2000),
    ("Chipmunk, no slop", CHIPMUNK,
     {"space_(cpSpaceNew()) {": "space_(cpSpaceNew()) { cpSpaceSetCollisionSlop(space_, 0.0);"}, 2000),
]


def lattice(words, where, *more):
    out = Path(where) / "out.json"
    cpu = cpu_of([gatewalk, "lattice", *words, *more, "--threads", 2, "--quiet", "--force", "--json", out])
    return json.loads(out.read_text()), cpu


def compiled(changes, where):
    """The program with these changes, each of which must be possible."""
    text = source.read_text()
    for old, new in changes.items():
        if text.count(old) != 1:
            raise SystemExit(f"{source}: {old} is not there once")
        text = text.replace(old, new)
    (Path(where) / "gate.cpp").write_text(text)
    subprocess.run(["c++", "-O2", "-o", f"{where}/gate", f"{where}/gate.cpp", "-lchipmunk"], check=True)
    return f"{where}/gate"


with tempfile.TemporaryDirectory() as where, open(folder / "gates.csv", "w", newline="") as file:
    table = csv.writer(file, lineterminator="\n")
    table.writerow(["what", "passages", *FACES, "mean_time_s", "as_Chipmunk", "cpu_s"])
    first = None
    for name, words, changes, passages in VARIANTS:
        if changes is not None:
            at = words.index("--cell-program") + 1
            words = [*words[:at], compiled(changes, where) if changes else program, *words[at:]]
        _, cpu = lattice(words, where, "--trials", passages, "--set", "field.max_gates=1", "--passages", f"{where}/p.csv")
        runs = list(csv.DictReader(open(f"{where}/p.csv")))
        out = [r["out"] for r in runs]
        if name == "Chipmunk":
            first = out
        same = "" if not words[0] == CHIPMUNK[0] else sum(a == b for a, b in zip(out, first)) / len(out)
        counts = Counter(out)
        time = sum(float(r["time_s"]) for r in runs) / len(runs)
        table.writerow([name, len(out), *(counts[f] for f in FACES), round(time, 4), same and round(same, 4), round(cpu, 2)])

with tempfile.TemporaryDirectory() as where, open(folder / "engines.csv", "w", newline="") as file:
    table = csv.writer(file, lineterminator="\n")
    table.writerow(["what", "trials", *ENDINGS, *GATES, "cpu_s"])
    for name, words, trials in ("Chipmunk", [*CHIPMUNK, program], 4000), ("ours", [FIELD], 100_000):
        j, cpu = lattice(words, where, "--trials", trials)
        table.writerow([name, j["trials"], *(j["endings"][e] for e in ENDINGS),
                        *(n for row in j["final_gates"] for n in row), round(cpu, 2)])
