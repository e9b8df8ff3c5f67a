#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Are tracks through a maze cut as their authors cut them? tracks.py GATEWALK FOLDER OUT.json

Takes the animal's nose, frame by frame (D9_tracks.csv.gz), and the map (maze_tracks.toml), whose types say which sides
of a square are open. Compares the sequence of squares of each bout with the authors' sequence (D9.csv)."""
import csv, gzip, json, math, re, subprocess, sys
from collections import defaultdict
from pathlib import Path

GATEWALK, FOLDER, OUT = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
MOVES = {"S": (0, 1), "N": (0, -1), "W": (1, 0), "E": (-1, 0)}  # of the faces by which a body enters
DOOR, FPS, SQUARE_M = (7, 0), 30, 0.04


def with_walls(match):
    open_sides = "" if match[1] == "void" else match[1][1:]
    return match[0] + "\nwalls = [" + ", ".join(f'"{f}"' for f in "SNWE" if f not in open_sides) + "]"


def edit_distance(a, b):
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        last, row[0] = row[0], i
        for j, y in enumerate(b, 1):
            last, row[j] = row[j], min(row[j] + 1, row[j - 1] + 1, last + (x != y))
    return row[-1]


toml = (FOLDER / "maze_tracks.toml").read_text()
Path("maze.toml").write_text(re.sub(r'\[\[cell.types\]\]\nname = "(\w+)"', with_walls, toml))
Path("tracks.csv").write_bytes(gzip.open(FOLDER / "D9_tracks.csv.gz").read())
subprocess.run([GATEWALK, "passages", "tracks.csv", "--cell", "maze.toml", "-o", "runs.csv", "--fps", str(FPS),
                "--metres-per-unit", str(SQUARE_M), "--columns", "body=body,frame=frame,x=x,y=y", "--fastest", "5",
                "--bridge", "30", "--visits", "visits.csv", "--json", "cut.json", "--quiet", "--force"], check=True)
cut = json.loads(Path("cut.json").read_text())

own, nose = defaultdict(list), defaultdict(dict)
for visit in csv.DictReader(open("visits.csv")):
    own[visit["body"]].append((int(visit["column"]), int(visit["row"])))
for place in csv.DictReader(open("tracks.csv")):
    nose[place["body"]][int(place["frame"])] = (math.floor(float(place["x"])), math.floor(float(place["y"])))

authors, inside, seen = defaultdict(list), 0, 0
for passage in csv.DictReader(open(FOLDER / "D9.csv")):
    squares = authors[passage["body"]]
    if not squares:
        squares.append(DOOR)
        frame = min(nose[passage["body"]])
        time = 0.0
    until = time + float(passage["time_s"])
    for f in range(frame + round(FPS * time), frame + round(FPS * until)):
        if f in nose[passage["body"]]:
            seen += 1
            inside += nose[passage["body"]][f] == squares[-1]
    time = until
    if passage["out"] in MOVES:
        move = MOVES[passage["out"]]
        squares.append((squares[-1][0] + move[0], squares[-1][1] + move[1]))

length = sum(len(s) for s in authors.values())
distance = sum(edit_distance(s, own[body]) for body, s in authors.items())
OUT.write_text(json.dumps({
    "squares_of_the_authors": length, "squares_cut": sum(len(own[b]) for b in authors),
    "one_less_edit_distance_over_length": round(1 - distance / length, 4),
    "trials": cut["trials"], "trials_ended_by_walls": cut["lost_by"]["wall"],
    "places": cut["tracks"]["places"], "places_put_back": cut["places_put_back"],
    "frames_with_the_nose_in_the_authors_square": round(inside / seen, 4)}, indent=2) + "\n")
