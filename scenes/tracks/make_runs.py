# SPDX-License-Identifier: MIT
"""Made-up runs in the form of recorded ones: python3 scenes/tracks/make_runs.py > scenes/tracks/runs.csv
A point walks straight through square cells of 0.1 m, turns a little wherever it enters one, and is now and then trapped
or lost from sight."""
import math
import random

draw = random.Random(5)
HALF = 0.05  # m

print("# Recorded passages for gatewalk build, through the cells of cell.toml. Made up by make_runs.py, no animal was tracked.")
print("body,trial,in,s,vx,vy,out,out_s,out_vx,out_vy,time_s")
for body in range(1, 13):
    face, s, direction, speed = "S", draw.uniform(-0.04, 0.04), math.pi / 2, draw.uniform(0.05, 0.2)
    for _ in range(5):
        vx, vy = speed * math.cos(direction), speed * math.sin(direction)
        entry = f"{face},{s:.4f},{vx:.4f},{vy:.4f}"
        x, y = {"S": (s, -HALF), "N": (s, HALF), "W": (-HALF, s), "E": (HALF, s)}[face]
        fate = draw.random()
        if fate < 0.08:
            print(f"b{body},1,{entry},trapped,,,,10")
            break
        if fate < 0.14:
            print(f"b{body},1,{entry},lost,,,,")
            break
        # To the next side of the cell; the body then enters the neighbour by the opposite one.
        to_side = (math.copysign(HALF, vx) - x) / vx if vx else math.inf
        to_end = (math.copysign(HALF, vy) - y) / vy if vy else math.inf
        time = min(to_side, to_end)
        if to_end < to_side:
            face, s = ("S" if vy > 0 else "N"), x + time * vx
        else:
            face, s = ("W" if vx > 0 else "E"), y + time * vy
        turned = direction + draw.gauss(0.0, 0.4)
        into = {"S": math.pi / 2, "N": -math.pi / 2, "W": 0.0, "E": math.pi}[face]
        direction = turned if math.cos(turned - into) > 0.1 else into  # no body turns back on a border
        vx, vy = speed * math.cos(direction), speed * math.sin(direction)
        print(f"b{body},1,{entry},{face},{s:.4f},{vx:.4f},{vy:.4f},{time:.3f}")
