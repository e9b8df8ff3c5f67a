#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A hopper on ground that is soft on the left of each cell and hard on the right. It gets on 9 times of 10 with a push of
1 J where it is soft, of 3 J where it is hard; 3 times of 10 with the other one. It comes down anywhere in the next cell."""
import json, sys

p = {"push_J": 2.0}
print(json.dumps({"gatewalk": 1, "uniforms": 2, "parameters": {"push_J": [p["push_J"], 1, 3]},
    "costs": [{"key": "time_s", "unit": "s"}, {"key": "work_J", "unit": "J"}],
    "coordinates": [{"name": "s", "unit": "m", "scale": 0.1}], "faces": [{"name": "S", "move": [0, 1]}]}), flush=True)

for word in map(str.split, sys.stdin):
    if not word: sys.stdout.flush()
    elif word[0] == "set": p[word[1]] = float(word[2])
    else:
        s, gets_on, lands = float(word[2]), float(word[4]), float(word[5])
        best = 1 if s < 0 else 3
        end = ("left", "S", lands - 0.5) if gets_on < 0.9 - 0.3 * abs(p["push_J"] - best) else ("trapped",)
        print(word[0], *end, 1.0, p["push_J"], *("-" for _ in end[1:2]))
