#!/usr/bin/python3
"""A planner of one's own for `ensonify explore --plugin`: goes to the nearest free column beside an unknown one.

One JSON line comes in for every ping and one goes out; docs/explore.md tells what is in them.
"""
import collections
import json
import math
import sys

import numpy as np

hello = json.loads(sys.stdin.readline())
origin, cell = hello["map"]["origin_m"], hello["map"]["resolution_m"]
reach = math.ceil((hello["vehicle"]["radius_m"] + 0.15) / cell)
disc = [(j, i) for j in range(-reach, reach + 1) for i in range(-reach, reach + 1) if math.hypot(i, j) <= reach]
centres = [[origin[1 - k] + (np.arange(hello["map"]["size"][1 - k]) + 0.5) * cell for k in (0, 1)][k] for k in (0, 1)]
inside = [(v >= hello["area"]["min"][1 - k]) & (v <= hello["area"]["max"][1 - k]) for k, v in enumerate(centres)]
area = inside[0][:, None] & inside[1][None, :]
trail = np.zeros_like(area)  # where it was it may go again, and about the start it is told that nothing stands
(x, y), yaw = [row[3] for row in hello["T_world_sonar_start"][:2]], 0.0
known = np.hypot(centres[0][:, None] - y, centres[1][None, :] - x) <= hello["known_free_m"]

for line in sys.stdin:
    T = json.loads(line)["T_world_sonar_est"]
    x, y, yaw = T[0][3], T[1][3], math.degrees(math.atan2(T[1][0], T[0][0]))
    log_odds = np.load(json.loads(line)["map"])["log_odds"]
    free, unknown = (log_odds < 0).all(axis=0) | known, (log_odds == 0).any(axis=0) & area & ~known
    room = np.logical_and.reduce([np.roll(free, shift, (0, 1)) for shift in disc]) & area | trail
    start = (int((y - origin[1]) / cell), int((x - origin[0]) / cell))
    trail[start] = True
    before, queue, goal = {start: None}, collections.deque([start]), None
    while queue and goal is None:
        j, i = here = queue.popleft()
        if unknown[max(0, j - 2 * reach):j + 2 * reach, max(0, i - 2 * reach):i + 2 * reach].any():
            goal = here
        for step in ((j + 1, i), (j - 1, i), (j, i + 1), (j, i - 1)):
            if 0 <= step[0] < room.shape[0] and 0 <= step[1] < room.shape[1] and room[step] and step not in before:
                before[step] = here
                queue.append(step)
    if goal is None or goal == start:  # nothing to go to from here: look around
        answer = {"pose": [x, y, 0, 0, 0, yaw + 20]}
    else:
        way = [goal]
        while before[way[-1]] != start:
            way.append(before[way[-1]])
        j, i = way[-1]
        ahead = way[max(0, len(way) - 10)]
        heading = math.degrees(math.atan2(ahead[0] - start[0], ahead[1] - start[1]))
        answer = {"pose": [centres[1][i], centres[0][j], 0, 0, 0, heading]}
    print(json.dumps(answer), flush=True)
