# SPDX-License-Identifier: Apache-2.0
"""Depth images of three spheres before a wall, and what a grid of voxels says about rays: slow and independent."""
import numpy as np

WIDTH, HEIGHT, FOCAL = 160, 120, 131.0
CENTER = np.array([79.5, 59.5])
SPHERES = [((-0.15, 0.05, 0.80), 0.12), ((0.18, -0.08, 0.85), 0.10), ((0.05, 0.15, 0.70), 0.06)]
WALL = (np.array([0.1, 0.05, -1.0]) / np.linalg.norm([0.1, 0.05, -1.0]), -1.05)  # n · p = d


def rays(width=WIDTH, height=HEIGHT, focal=FOCAL, center=CENTER):
    u, v = np.meshgrid(np.arange(width), np.arange(height))
    return np.stack([(u - center[0]) / focal, (v - center[1]) / focal, np.ones(u.shape)], -1)


def depth_from(rotation=np.eye(3), translation=np.zeros(3)):
    d = rays() @ np.asarray(rotation).T
    o = np.asarray(translation, float)
    normal, offset = WALL
    depth = (offset - normal @ o) / (d @ normal)
    for center, radius in SPHERES:
        to = o - np.array(center)
        a, b, c = (d * d).sum(-1), d @ to, to @ to - radius * radius
        inside = b * b - a * c
        t = (-b - np.sqrt(np.maximum(inside, 0))) / a
        depth = np.where((inside > 0) & (t > 0) & (t < depth), t, depth)
    return depth.astype(np.float32)


def distance_to_surface(points):
    normal, offset = WALL
    distances = [np.abs(points @ normal - offset)]
    distances += [np.abs(np.linalg.norm(points - np.array(c), axis=1) - r) for c, r in SPHERES]
    return np.min(distances, axis=0)


def first_states(grid, low, voxel, directions, origin, near=0.0, step=0.05):
    """State (1, 0, or -1 where nothing stops it) and depth along each ray, in steps of a twentieth of a voxel.

    grid: z, y, x; what lies outside it is passed over."""
    flat = directions.reshape(-1, 3)
    state = np.full(len(flat), -1.0)
    depth = np.zeros(len(flat))
    going = np.ones(len(flat), bool)
    shape = np.array(grid.shape[::-1])
    for t in np.arange(near, 3.0, step * voxel):
        index = np.floor((origin + t * flat[going] - low) / voxel).astype(int)
        inside = ((index >= 0) & (index < shape)).all(1)
        here = np.full(len(index), -1.0)
        x, y, z = index[inside].T
        here[inside] = grid[z, y, x]
        stopped = np.flatnonzero(going)[here != -1]
        state[stopped] = here[here != -1]
        depth[stopped] = t
        going[stopped] = False
        if not going.any():
            break
    return state, depth
