#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Cost of Python: a 640 x 480 frame from NumPy beside the same in C++, and a gain over 2,880 candidates beside its body.

evidence_python.py      PYTHONPATH names the built module; exit status 1: a frame
that lies in one piece costs more than 0.2 ms, or the gain more than 5 %"""
import sys
import time

import numpy as np

import saccade


def integrating():
    """Milliseconds that a call takes longer than the fusion in it, once the map has seen the scene."""
    camera = saccade.PinholeCamera(640, 480, fx=525, fy=525)
    m = saccade.TsdfMap(voxel_size_m=0.01, workspace=((-0.5, -0.5, -0.1), (0.5, 0.5, 0.5)))
    pose = saccade.look_at((0, 0, 1), (0, 0, 0))
    metres = np.full((480, 640), 1.0, np.float32)
    for _ in range(200):
        m.integrate(camera, metres, pose)
    for name, depth in (("float32", metres), ("uint16", (1000 * metres).astype(np.uint16)), ("float32, every other row and column",
                        np.ones((960, 1280), np.float32)[::2, ::2])):
        longer = []
        for _ in range(200):
            begin = time.perf_counter()
            stats = m.integrate(camera, depth, pose)
            longer.append(1e3 * (time.perf_counter() - begin) - stats["ms"])
        print(f"integrate {name}: {np.median(longer):.3f} ms beside the fusion's {stats['ms']:.1f} ms")
        if depth.flags.c_contiguous:  # others need every line of memory for half of its pixels
            yield np.median(longer)


def ranking():
    """Share by which a choice among candidates takes longer than the body of the gain: all else, in Python and in C++."""
    camera = saccade.trial.SimulatedCamera("tabletop-1", width=320)
    m = saccade.TsdfMap(voxel_size_m=0.01, truncation_vox=2, workspace=camera.workspace)
    for pose in camera.scan:
        m.integrate(camera.intrinsics, camera.capture(pose), pose)
    bodies, candidates, beside = [], [], []

    def gain(context, poses):
        begin = time.perf_counter()
        gains = saccade.view_gains(context.map, context.region, poses, context.sensor)
        bodies.append(time.perf_counter() - begin)
        candidates.append(len(poses))
        return gains

    chooser = saccade.ViewPlanner(camera.intrinsics, saccade.Strategy("sphere", gain=gain), radii_m=[0.6, 0.8, 1.0])
    for _ in range(5):
        begin = time.perf_counter()
        chooser.next_views(m)
        beside.append(time.perf_counter() - begin - bodies[-1])
    share = np.median(beside) / np.median(bodies)
    print(f"{candidates[0]} candidates: {1e3 * np.median(bodies):.1f} ms in the gain's body (rays, in C++), {1e3 * np.median(beside):.2f} ms "
          f"beside it: {100 * share:.2f} %")
    return share


if __name__ == "__main__":
    longest = max(integrating())
    share = ranking()
    sys.exit(0 if longest <= 0.2 and share <= 0.05 else 1)
