#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A walker of 1 m/s whose heading drifts, among round pillars in the middle of square cells of 1 m."""
import json, math, random, sys

p, step = {"radius_m": 0.3, "turning_rad_per_sqrt_s": 0.7}, 0.02
faces = [("S", [0, 1], "S", ["s", "v"]), ("N", [0, -1], "N", ["s", "v"]), ("W", [1, 0], "E", []), ("E", [-1, 0], "W", [])]
print(json.dumps({"gatewalk": 1, "symmetric": True, "parameters": p, "costs": [{"key": "time_s", "unit": "s"}],
    "coordinates": [{"name": "s", "unit": "m", "scale": 0.1}, {"name": "v", "unit": "m s-1", "scale": 0.1}],
    "faces": [dict(zip(("name", "move", "mirror", "odd"), face)) for face in faces]}), flush=True)

def passage(face, s, v, seed):
    noise, into = random.Random(seed), math.sqrt(max(1 - v * v, 0))
    x, y, vx, vy = {"S": (s, -.5, v, into), "N": (s, .5, v, -into), "W": (-.5, s, into, v), "E": (.5, s, -into, v)}[face]
    for k in range(1000):
        to_x, to_y = ((math.copysign(.5, v) - at) / v if v else step for at, v in ((x, vx), (y, vy)))
        if (t := min(to_x, to_y)) < step:  # it leaves within this step
            out = ("NS"[vy > 0], x + t * vx, vx) if to_y < to_x else ("EW"[vx > 0], y + t * vy, vy)
            return ("left", *out, k * step + max(t, 0), "-")
        angle = math.atan2(vy, vx) + p["turning_rad_per_sqrt_s"] * math.sqrt(step) * noise.gauss(0, 1)
        x, y, vx, vy = x + step * vx, y + step * vy, math.cos(angle), math.sin(angle)
        if math.hypot(x, y) < p["radius_m"] and (closing := (x * vx + y * vy) / (x * x + y * y)) < 0:  # a bounce
            vx, vy = vx - 2 * closing * x, vy - 2 * closing * y
    return ("trapped", 1000 * step)

for word in map(str.split, sys.stdin):
    if not word: sys.stdout.flush()
    elif word[0] == "set": p[word[1]] = float(word[2])
    else: print(word[0], *passage(word[1], float(word[2]), float(word[3]), int(word[4])))
