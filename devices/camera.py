#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A camera for Saccade (docs/guides/processes.md). It sees a ball on a plane; put your own camera in its place.

To make it yours: open the camera before the loop, say what it is in HELLO, and take a frame in capture()."""
import array
import json
import math
import sys

HELLO = {"saccade": 1, "width": 160, "height": 120, "fx": 131.25, "fy": 131.25, "cx": 79.5, "cy": 59.5,
         "min_range_m": 0.1, "max_range_m": 3.0, "depth": "float32_m", "color": "none"}
BALL_CENTER, BALL_RADIUS = (0.0, 0.0, 0.1), 0.1  # metres, world frame; the plane is z = 0


def depth_along(origin, ray):
    """Depth of the nearest surface along a ray of length 1 along the camera's z; nothing near: free up to the maximum."""
    nearest = HELLO["max_range_m"] + 1e-9
    if ray[2] < 0 < origin[2]:
        nearest = min(nearest, -origin[2] / ray[2])
    to_ball = [c - o for c, o in zip(BALL_CENTER, origin)]
    a, b = sum(r * r for r in ray), sum(r * t for r, t in zip(ray, to_ball))
    under_root = b * b - a * (sum(t * t for t in to_ball) - BALL_RADIUS ** 2)
    if under_root > 0 and b > math.sqrt(under_root):
        nearest = min(nearest, (b - math.sqrt(under_root)) / a)
    return nearest if nearest <= HELLO["max_range_m"] else -HELLO["max_range_m"]


def capture(T_world_camera):
    """Depth in metres along the camera's z, row by row."""
    R = [row[:3] for row in T_world_camera[:3]]
    origin = [row[3] for row in T_world_camera[:3]]
    depth = array.array("f")
    for v in range(HELLO["height"]):
        y = (v - HELLO["cy"]) / HELLO["fy"]
        for u in range(HELLO["width"]):
            x = (u - HELLO["cx"]) / HELLO["fx"]
            depth.append(depth_along(origin, [r[0] * x + r[1] * y + r[2] for r in R]))
    if sys.byteorder == "big":
        depth.byteswap()
    return depth.tobytes()


def answer(message, data=b""):
    sys.stdout.buffer.write(json.dumps(message).encode() + b"\n" + data)
    sys.stdout.buffer.flush()


for line in sys.stdin:  # ends when Saccade is done
    request = json.loads(line)
    if request["request"] == "hello":
        answer(HELLO)
    elif request["request"] == "capture":
        image = capture(request["T_world_camera"])
        answer({"number": request["number"], "bytes": len(image)}, image)
    else:
        answer({"error": "unknown request " + request["request"]})
