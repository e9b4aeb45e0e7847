#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A robot for Saccade (docs/guides/processes.md). It reaches a box; put your own arm in its place.

To make it yours: connect to the arm before the loop, and in move() bring the camera to the pose and read where it is."""
import json
import sys

REACH_MIN, REACH_MAX = (-0.8, -0.8, 0.05), (0.8, 0.8, 1.2)  # metres, world frame


def move(T_world_camera):
    position = [row[3] for row in T_world_camera[:3]]
    for axis, value, low, high in zip("xyz", position, REACH_MIN, REACH_MAX):
        if not low <= value <= high:
            return {"reached": False, "why": f"{axis} = {value:.3f} m is not within {low} and {high} m"}
    # An arm moves here, waits until it stands still, and then says where its joints have brought the camera.
    return {"reached": True, "T_world_camera": T_world_camera}


def answer(message):
    print(json.dumps(message), flush=True)


for line in sys.stdin:  # ends when Saccade is done: bring the arm to rest
    request = json.loads(line)
    if request["request"] == "hello":
        answer({"saccade": 1})
    elif request["request"] == "move":
        answer({"number": request["number"], **move(request["T_world_camera"])})
    else:
        answer({"error": "unknown request " + request["request"]})
