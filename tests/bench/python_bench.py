# SPDX-License-Identifier: MIT
"""What a call from Python costs beyond the library's own time, and what a passage through a cell in numpy costs beside C++.

Usage: python_bench.py PYTHON_BENCH CELLS.toml FOLDER        (gatewalk importable; FOLDER gets calls.csv and passages.csv)
"""

import statistics
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

import gatewalk as gw

TIMES, TRIALS, STEPS, STEP = 200, 100_000, 200, 0.02


class Pillars(gw.Cell):
    """scenes/programs/pillars.py with a time limit of 200 steps; all bodies of a batch step together."""

    faces = [{"name": "S", "move": [0, 1], "odd": ["s", "v"]}, {"name": "N", "move": [0, -1], "odd": ["s", "v"]},
             {"name": "W", "move": [1, 0], "mirror": "E"}, {"name": "E", "move": [-1, 0], "mirror": "W"}]
    coordinates = [{"name": "s", "unit": "m", "scale": 0.1}, {"name": "v", "unit": "m s-1", "scale": 0.1}]
    symmetric, normals = True, STEPS
    parameters = {"radius_m": 0.3, "turning": 0.7}

    def __init__(self):
        self.passages, self.seconds = 0, 0.0

    def pass_(self, entries, random):
        begin = time.process_time()
        out = self.carry(entries, random.normals * (self.parameters["turning"] * STEP**0.5))
        self.passages, self.seconds = self.passages + len(out["face"]), self.seconds + time.process_time() - begin
        return out

    def carry(self, entries, turns):
        face, s, v = entries["face"], entries["s"], entries["v"]
        sign, along_y = np.where(face % 2 == 0, 1.0, -1.0), face < 2
        into = sign * np.sqrt(np.maximum(1 - v * v, 0))
        x, y = np.where(along_y, s, -0.5 * sign), np.where(along_y, -0.5 * sign, s)
        vx, vy = np.where(along_y, v, into), np.where(along_y, into, v)
        out = {"face": np.full(len(face), gw.TRAPPED), "s": np.zeros(len(face)), "v": np.zeros(len(face)),
               "time_s": np.full(len(face), STEPS * STEP)}
        who = np.arange(len(face))  # those that are still in the cell
        for k in range(STEPS):
            with np.errstate(divide="ignore", invalid="ignore"):
                to_x = np.where(vx != 0, (np.copysign(0.5, vx) - x) / vx, STEP)
                to_y = np.where(vy != 0, (np.copysign(0.5, vy) - y) / vy, STEP)
            to_edge = np.minimum(to_x, to_y)
            leaves = to_edge < STEP
            if leaves.any():
                gone, t, by_y = who[leaves], to_edge[leaves], (to_y < to_x)[leaves]
                out["face"][gone] = np.where(by_y, np.where(vy[leaves] > 0, 0, 1), np.where(vx[leaves] > 0, 2, 3))
                out["s"][gone] = np.where(by_y, x[leaves] + t * vx[leaves], y[leaves] + t * vy[leaves])
                out["v"][gone] = np.where(by_y, vx[leaves], vy[leaves])
                out["time_s"][gone] = k * STEP + np.maximum(t, 0)
                x, y, vx, vy, who = x[~leaves], y[~leaves], vx[~leaves], vy[~leaves], who[~leaves]
                if not len(who):
                    break
            angle = np.arctan2(vy, vx) + turns[who, k]
            x, y, vx, vy = x + STEP * vx, y + STEP * vy, np.cos(angle), np.sin(angle)
            rr = x * x + y * y
            closing = (x * vx + y * vy) / rr
            hits = (rr < self.parameters["radius_m"]**2) & (closing < 0)
            vx, vy = np.where(hits, vx - 2 * closing * x, vx), np.where(hits, vy - 2 * closing * y, vy)
        return out


def calls(bench, folder):
    """A line per matrix, medians in ms of CPU: the library's own time, what gw.predict adds to it, and what the same command adds
    in C++."""
    field = gw.Scene(gw.sample("field"))
    matrices = {"3 x 3 gates": gw.build(field.with_set({"field.columns": 3, "field.rows": 3}), accuracy=0.1),
                "9 x 9 gates": gw.build(field, accuracy=0.1)}
    lines = ["matrix,states,library_ms,python_adds_ms,command_adds_ms"]
    for name, matrix in matrices.items():
        told = subprocess.run([bench, "predict", matrix._path, str(TIMES)], check=True, capture_output=True, text=True).stdout
        library, command = np.array([line.split(",") for line in told.split()], dtype=float).T
        gw.predict(matrix)
        python = []
        for _ in range(TIMES):
            begin = time.process_time()
            gw.predict(matrix)
            python.append(1e3 * (time.process_time() - begin))
        own, by_command, by_python = map(statistics.median, (library, command, python))
        lines.append(f"{name},{len(matrix.states)},{own:.3f},{by_python - own:.3f},{by_command - own:.3f}")
    (folder / "calls.csv").write_text("\n".join(lines) + "\n")


def passages(bench, cells, folder):
    """A line per language: passages, microseconds of CPU each; as many bodies must cross the field."""
    told = subprocess.run([bench, "pillars", cells, str(TRIALS)], check=True, capture_output=True, text=True).stdout.split(",")
    cell = Pillars()
    begin = time.process_time()
    seen = gw.lattice(cells, cell=cell, trials=TRIALS)
    wall = time.process_time() - begin
    here, there = seen.endings["crossed"] / TRIALS, float(told[2])
    spread = 5 * (here * (1 - here) / TRIALS * 2) ** 0.5  # five standard errors of the difference
    if abs(here - there) > spread:
        raise SystemExit(f"crossed: {here} in numpy, {there} in C++")
    lines = ["cell,passages,us_each,crossed", f"C++,{told[0]},{told[1]},{there}",
             f"numpy,{cell.passages},{1e6 * wall / cell.passages:.4f},{here:.4f}",
             f"numpy: in pass_ alone,{cell.passages},{1e6 * cell.seconds / cell.passages:.4f},{here:.4f}"]
    (folder / "passages.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    gw.threads(1)
    calls(sys.argv[1], Path(sys.argv[3]))
    passages(sys.argv[1], sys.argv[2], Path(sys.argv[3]))
