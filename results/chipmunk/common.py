# SPDX-License-Identifier: MIT
"""What the scripts of this study share."""
import os, random, subprocess
from pathlib import Path

ENDINGS = ["crossed", "left_side", "right_side", "trapped", "cut_off"]
GATES = [f"gate_{x}_{y}" for y in range(9) for x in range(-4, 5)]
LAYER = 100  # trials of a line of direct.csv
FIELD = Path(__file__).resolve().parents[2] / "scenes/field.toml"


def drawn(count):
    """Starts from anywhere in the range of entries from below (cell.toml)."""
    own = random.Random(1)
    return [tuple(round(own.uniform(*r), 3) for r in ((-25, 25), (-25, 25), (10, 20)))
            for _ in range(count)]


STARTS = drawn(300)


def key_of(start):
    return " ".join(map(str, start))


def cpu_of(words):
    """Runs a command; seconds of CPU of it and of all that it started."""
    process = subprocess.Popen([str(w) for w in words], stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"failed: {words}")
    process.returncode = 0
    return usage.ru_utime + usage.ru_stime
