# SPDX-License-Identifier: MIT
"""Made-up tracks: python3 scenes/tracks/make_tracks.py > scenes/tracks/tracks.csv
Points walk through square cells of 0.1 m, as seen by a camera above: ten frames a second, a place in mm that is off by
0.3 mm. They turn a little all the time, and now and then stay where they are. Every number follows from the seed."""
import math
import random

draw = random.Random(5)
FPS, CELL = 10, 100.0  # frames per second, mm

print("# Tracks for gatewalk passages: 48 points among cells, mm. Made up by make_tracks.py, no animal was tracked.")
print("# gatewalk passages tracks.csv --cell cell.toml -o passages.csv --fps 10 --metres-per-unit 0.001 --fastest 0.4")
print("#   --lattice 9,9 --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y")
print("TRACK_ID,FRAME,POSITION_X,POSITION_Y")
for body in range(1, 49):
    x, y = 450.0 + draw.uniform(-40.0, 40.0), -15.0
    speed, heading, stays = draw.uniform(80.0, 200.0), 0.0, False
    frame = first = draw.randrange(200)
    while frame - first < 90 or (stays and frame - first < 160):
        print(f"{body},{frame},{x + draw.gauss(0.0, 0.3):.1f},{y + draw.gauss(0.0, 0.3):.1f}")
        frame += 1
        stays = stays or (y > 0.0 and draw.random() < 0.01)
        if stays:
            continue
        heading = 0.9 * heading + draw.gauss(0.0, 0.25)  # 0: ahead
        x += speed / FPS * math.sin(heading)
        y += speed / FPS * math.cos(heading)
        if not (0.0 < x < 9 * CELL and y < 9 * CELL):
            break
