#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Gives each fork of the maze (a square with three open sides) a type of its own.

    forks.py RUNS.csv CELL.toml FORKS.csv FORKS.toml
"""
import csv
import sys
import tomllib
from pathlib import Path

runs, cell, new_runs, new_cell = sys.argv[1:]
text = Path(cell).read_text()
maze = tomllib.loads(text)
squares = [row.split(",") for row in reversed(maze["terrain"]["map"])]  # from the home cage on
moves = {face["name"]: face["move"] for face in maze["cell"]["faces"]}
is_fork = lambda kind: kind.startswith("o") and len(kind) == 4
forks = [(x, y) for y, row in enumerate(squares) for x, kind in enumerate(row) if is_fork(kind)]
for x, y in forks:
    squares[y][x] = f"fork_{x}_{y}"

with open(runs) as old, open(new_runs, "w", newline="") as new:
    rows = csv.DictReader(old)
    table = csv.DictWriter(new, rows.fieldnames)
    table.writeheader()
    trial = None
    for row in rows:
        if trial != (row["body"], row["trial"]):
            trial, x, y = (row["body"], row["trial"]), len(squares[0]) // 2, 0
        row["type"] = squares[y][x]
        table.writerow(row)
        if row["out"] in moves:
            x, y = x + moves[row["out"]][0], max(0, y + moves[row["out"]][1])

before = text.split("[[cell.types]]")[0]
names = sorted({kind for row in squares for kind in row})
types = "".join(f'[[cell.types]]\nname = "{name}"\n\n' for name in names)
rows = ",\n".join(f'  "{",".join(row)}"' for row in reversed(squares))
field = maze["field"]
Path(new_cell).write_text(
    f"{before}{types}[field]\ncolumns = {field['columns']}\nrows = {field['rows']}\nmax_gates = 0\n\n"
    f"[terrain]\nmap = [\n{rows}\n]\n")
