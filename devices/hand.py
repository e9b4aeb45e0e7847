#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The tracker of a hand for Saccade (docs/guides/processes.md). It plays a recording in its own time; put your own tracker in.

The recording is a text file with a line per sample: seconds, x, y, z in metres; other columns and lines are passed over.
To make it yours: connect to the tracker before the loop, and wait for its next reading in next_sample(). An optional
second argument is how much faster than real time it plays."""
import json
import re
import sys
import time

RATE = float(sys.argv[2]) if len(sys.argv) > 2 else 1.0


def samples_of(path):
    with open(path, encoding="utf-8") as file:
        for line in file:
            fields = re.split(r"[,;\s]+", line.strip())
            try:
                yield [float(field) for field in fields[:4]]
            except ValueError:
                continue  # a header, or a comment


samples = samples_of(sys.argv[1])
first_s = None
start = time.monotonic()


def next_sample():
    """Time and position of the hand; no position where it is not seen; None at the end."""
    global first_s
    sample = next(samples, None)
    if sample is None or len(sample) < 4:
        return None
    first_s = sample[0] if first_s is None else first_s
    time.sleep(max((sample[0] - first_s) / RATE - (time.monotonic() - start), 0.0))
    return sample[0], sample[1:]


def answer(message):
    print(json.dumps(message), flush=True)


for line in sys.stdin:  # ends when Saccade is done, or gone
    request = json.loads(line)
    if request["request"] == "hello":
        answer({"saccade": 1})
    elif request["request"] == "sample":
        sample = next_sample()
        if sample is None:
            answer({"number": request["number"], "end": True})
        else:
            answer({"number": request["number"], "time_s": sample[0], "position": sample[1]})
    else:
        answer({"error": "unknown request " + request["request"]})
