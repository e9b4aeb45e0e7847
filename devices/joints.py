#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The joints of an arm for Saccade (docs/guides/processes.md). They do exactly what they are told; put your own arm in.

To make it yours: connect to the arm before the loop, read its joints in position(), and send it a set point in
set_position(), or the whole list of points where your controller takes trajectories. An optional argument is how much
faster than real time it moves, for tries without an arm."""
import bisect
import json
import os
import select
import sys
import time

RATE = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
PERIOD_S = 0.02  # positions on the way are told 50 times a second
q = None         # radians, metres for prismatic joints


def position():
    return q


def set_position(wanted):
    global q
    q = wanted


def answer(message):
    sys.stdout.write(json.dumps(message) + "\n")
    sys.stdout.flush()


def lines():
    """Lines of the standard input as they come: None while there is none; ends when Saccade is done, or gone."""
    received = b""
    while True:
        while b"\n" in received:
            line, received = received.split(b"\n", 1)
            yield json.loads(line)
        if not select.select([0], [], [], PERIOD_S / RATE)[0]:
            yield None
            continue
        chunk = os.read(0, 1 << 16)
        if not chunk:
            return
        received += chunk


def state_at(points, t_s):
    """Joint positions of a trajectory, straight between its points."""
    i = min(max(bisect.bisect([p["t_s"] for p in points], t_s), 1), len(points) - 1)
    a, b = points[i - 1], points[i]
    share = 1.0 if b["t_s"] == a["t_s"] else min(max((t_s - a["t_s"]) / (b["t_s"] - a["t_s"]), 0.0), 1.0)
    return [x + share * (y - x) for x, y in zip(a["q"], b["q"])]


motion = None  # (number, points, start) of the motion under way
for request in lines():
    kind = request["request"] if request else None
    if kind == "hello":
        limits = zip(request["lower"], request["upper"])  # null: the joint turns without end
        q = [0.0 if low is None else 0.5 * (low + high) for low, high in limits]
        answer({"saccade": 1})
    elif kind == "joints":
        answer({"number": request["number"], "q": position(), "time_s": time.time()})
    elif kind == "follow":
        motion = (request["number"], request["points"], time.monotonic())
    elif kind == "stop":  # the one request that may come while another is not answered: that one gets no more answers
        motion = None
        answer({"number": request["number"], "q": position()})
    elif kind:
        answer({"error": "unknown request " + kind})
    if motion:
        number, points, start = motion
        t_s = min(RATE * (time.monotonic() - start), points[-1]["t_s"])
        set_position(state_at(points, t_s))
        done = t_s >= points[-1]["t_s"]
        answer({"number": number, "done": done, "t_s": t_s, "q": position(), "time_s": time.time()})
        motion = None if done else motion
