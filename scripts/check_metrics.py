#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Computes the figures of an exploration a second time, from its exported files alone, and compares.

RUN is the folder of `saccade explore` (run.json, mesh.ply, ternary.npy), EXPORT that of `saccade scene export` for the
same scene. Everything is done the slow and plain way, from the definitions in docs/reference/metrics.md. Both figures are printed
side by side. Exit status: 0 when all agree, 1 when one does not, 2 when the files do not belong together."""
import argparse
import json
import math
import pathlib
import sys

import numpy as np

F_SCORE_M = 0.005       # distance up to which a point counts
NEAR_OBJECTS_M = 0.03   # unknown_near_objects
AT_OBJECT_M = 0.05      # points_at_object
LENGTH_TOLERANCE_M = 1e-6
TOO_CLOSE_M = 1e-9      # to a limit, for two computations to agree on which side of it a point lies
CELL_M = 0.05           # edge of the groups in which points are compared with triangles
PAIRS = 500_000         # point-triangle pairs at a time


class Mismatch(Exception):
    """The files cannot be compared."""


# --- files -----------------------------------------------------------------------------------------------------------

PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
             "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
             "float32": "f4", "float64": "f8"}


def read_ply(path):
    """Elements of a binary little-endian PLY file by name: records; for faces an array of three indices each."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    elements = []
    for line in data[:end].decode("ascii").splitlines():
        words = line.split()
        if words[0] == "format" and words[1] != "binary_little_endian":
            raise Mismatch(f"{path}: only binary little-endian PLY is read")
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property" and words[1] == "list":
            elements[-1][2].append(("count", "<" + PLY_TYPES[words[2]]))
            elements[-1][2].append(("corners", "<" + PLY_TYPES[words[3]], (3,)))
        elif words[0] == "property":
            elements[-1][2].append((words[2], "<" + PLY_TYPES[words[1]]))
    content = {}
    for name, rows, fields in elements:
        table = np.frombuffer(data, dtype=np.dtype(fields), count=rows, offset=end)
        end += table.nbytes
        if "count" in table.dtype.names and not np.all(table["count"] == 3):
            raise Mismatch(f"{path}: only triangles are read")
        content[name] = table
    return content


def positions(table):
    return np.stack([table[axis].astype(float) for axis in "xyz"], axis=1)


def corners(ply):
    """Triangles as an array (n, 3 corners, 3 coordinates)."""
    if "face" not in ply or len(ply["face"]) == 0:
        return np.empty((0, 3, 3))
    return positions(ply["vertex"])[ply["face"]["corners"]]


class States:
    """The voxels of the workspace: 0 unknown, 1 empty, 2 occupied."""

    def __init__(self, run):
        about = json.loads((run / "ternary.json").read_text())
        self.state = np.load(run / about["file"])
        self.edge_m = about["voxel_size_m"]
        self.first = about["first_voxel"]

    def centers(self, chosen):
        z, y, x = np.nonzero(chosen)
        return (np.stack([x, y, z], axis=1) + np.array(self.first) + 0.5) * self.edge_m


def load_result(run):
    document = json.loads((run / "run.json").read_text())
    if document.get("command") != "explore":
        raise Mismatch(f"{run}: is no run of saccade explore")
    if document["result"]["final"]["coverage"] is None:
        raise Mismatch(f"{run}: a real camera has no truth to compare with")
    return document["result"]


# --- geometry --------------------------------------------------------------------------------------------------------

def dot(a, b):
    return np.einsum("...k,...k->...", a, b)


def pair_distances(p, a, b, c):
    """From each point to each triangle: to its plane where the point lies above the triangle, else to its outline."""
    center = p.mean(axis=0)  # numbers stay small, so that nothing is lost in differences of squares
    p, a, b, c = p - center, a - center, b - center, c - center
    normal = np.cross(b - a, c - a)
    length = np.sqrt(dot(normal, normal))
    normal /= np.where(length > 0, length, 1.0)[:, None]
    above = np.broadcast_to(length > 0, (len(p), len(a)))
    outline = np.full(above.shape, math.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        along = end - start
        squared = dot(along, along)
        run = p @ along.T - dot(start, along)  # how far along the edge, times its length
        t = np.minimum(np.maximum(run / np.where(squared > 0, squared, 1.0), 0.0), 1.0)
        to_start = dot(p, p)[:, None] - 2.0 * (p @ start.T) + dot(start, start)
        outline = np.minimum(outline, to_start + t * (t * squared - 2.0 * run))
        inward = np.cross(normal, along)
        above = above & (p @ inward.T >= dot(start, inward))
    height = p @ normal.T - dot(a, normal)
    return np.sqrt(np.where(above, height * height, np.maximum(outline, 0.0)))


def distances(points, triangles):
    """From each point to the nearest triangle. Points go in groups of neighbours; triangles that cannot be the nearest
    of any of a group, since their bounds lie beyond a corner of another one, are left out."""
    result = np.full(len(points), math.inf)
    if len(points) == 0 or len(triangles) == 0:
        return result
    low, high, corner = triangles.min(axis=1), triangles.max(axis=1), triangles[:, 0]
    _, group = np.unique(np.floor(points / CELL_M).astype(int), axis=0, return_inverse=True)
    group = group.reshape(-1)
    order = np.argsort(group, kind="stable")
    for members in np.split(order, np.flatnonzero(np.diff(group[order])) + 1):
        p = points[members]
        p_low, p_high = p.min(axis=0), p.max(axis=0)
        farthest = np.maximum(np.abs(corner - p_low), np.abs(corner - p_high))
        enough = math.sqrt(dot(farthest, farthest).min())
        gap = np.maximum(np.maximum(low - p_high, p_low - high), 0.0)
        near = triangles[dot(gap, gap) <= (enough * (1 + 1e-9)) ** 2]
        step = max(1, PAIRS // len(near))
        for at in range(0, len(p), step):
            result[members[at:at + step]] = pair_distances(p[at:at + step], *near.transpose(1, 0, 2)).min(axis=1)
    return result


def in_box(p, box):
    return np.all((p >= box[0]) & (p < box[1]), axis=-1)


def spread_points(triangles, spacing_m, box):
    """The points of the mesh that count; docs/reference/metrics.md says where they lie."""
    points, owed, n = [], 0.5, 0
    ab, ac = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    normal = np.cross(ab, ac)
    due = 0.5 * np.sqrt(dot(normal, normal)) / spacing_m ** 2
    outside = np.any((triangles.min(axis=1) > box[1]) | (triangles.max(axis=1) < box[0]), axis=1)
    for i in np.flatnonzero(~outside):
        owed += due[i]
        while owed >= 1.0:
            s, t = (0.5 + 0.7548776662466927 * n) % 1.0, (0.5 + 0.5698402909980532 * n) % 1.0
            if s + t > 1.0:
                s, t = 1.0 - s, 1.0 - t
            points.append(triangles[i, 0] + s * ab[i] + t * ac[i])
            owed, n = owed - 1.0, n + 1
    points = np.array(points).reshape(-1, 3)
    return points[in_box(points, box)].astype(np.float32).astype(float)


def random_points(triangles, count, box):
    """As many points, at random."""
    random = np.random.default_rng(1)
    ab, ac = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    normal = np.cross(ab, ac)
    area = np.sqrt(dot(normal, normal))
    chosen = random.choice(len(triangles), size=count, p=area / area.sum())
    s, t = random.random((2, count))
    s, t = np.where(s + t > 1, 1 - s, s), np.where(s + t > 1, 1 - t, t)
    points = triangles[chosen, 0] + s[:, None] * ab[chosen] + t[:, None] * ac[chosen]
    return points[in_box(points, box)]


def inside(points, body):
    """Tells whether points lie in a closed body: upwards they leave it through more triangles than they enter it by."""
    result = np.zeros(len(points), dtype=bool)
    low, high = body.min(axis=1), body.max(axis=1)
    candidates = np.flatnonzero(np.all((points >= low.min(axis=0)) & (points <= high.max(axis=0)), axis=1))
    columns, column = np.unique(points[candidates, :2], axis=0, return_inverse=True)
    column = column.reshape(-1)
    order = np.argsort(column, kind="stable")
    for members in np.split(order, np.flatnonzero(np.diff(column[order])) + 1) if len(order) else []:
        x, y = columns[column[members[0]]] + np.array([1.7e-8, 2.9e-8])  # a hair aside, so that no edge is met
        a, b, c = body[(low[:, 0] <= x) & (high[:, 0] >= x) & (low[:, 1] <= y) & (high[:, 1] >= y)].transpose(1, 0, 2)

        def turn(u, v):
            return (u[:, 0] - x) * (v[:, 1] - y) - (u[:, 1] - y) * (v[:, 0] - x)

        weights = np.stack([turn(b, c), turn(c, a), turn(a, b)])
        met = np.all(weights > 0, axis=0) | np.all(weights < 0, axis=0)
        area = weights[:, met].sum(axis=0)
        z = (weights[:, met] * np.stack([a, b, c])[:, met, 2]).sum(axis=0) / area
        up = np.where(area > 0, 1, -1)
        z_points = points[candidates[members], 2]
        result[candidates[members]] = ((z > z_points[:, None]) * up).sum(axis=1) > 0
    return result


# --- figures ---------------------------------------------------------------------------------------------------------

class Comparison:
    """Rows of name, reported and recomputed figure, and by how much they may differ."""

    def __init__(self):
        self.good = True
        print(f"{'figure':<34}{'run.json':>16}{'recomputed':>16}{'difference':>13}{'tolerance':>12}")

    def row(self, name, reported, computed, tolerance=0.0):
        def text(value):
            return "null" if value is None else f"{value:.9f}" if isinstance(value, float) else str(value)

        numbers = reported is not None and computed is not None
        difference = abs(float(reported) - float(computed)) if numbers else 0.0
        good = difference <= tolerance if numbers else reported is computed
        self.good = self.good and good
        print(f"{name:<34}{text(reported):>16}{text(computed):>16}{difference:>13.2e}{tolerance:>12.1e}"
              f"{'' if good else '  DIFFERS'}")


def share(d, limit):
    """The share within the limit, and of those too close to it to be told."""
    return float(np.mean(d <= limit)), float(np.mean(np.abs(d - limit) <= TOO_CLOSE_M))


class Truth:
    """Files written by `saccade scene export`."""

    def __init__(self, export):
        self.scene = json.loads((export / "scene.json").read_text())
        ply = read_ply(export / "true_mesh.ply")
        triangles = corners(ply)
        label = ply["vertex"]["label"][ply["face"]["corners"][:, 0]]
        self.bodies = [triangles[label == o["label"]] for o in self.scene["objects"]]
        support = np.array([o["support"] for o in self.scene["objects"]])
        self.objects, self.supports = triangles[~support[label]], triangles[support[label]]
        surface = read_ply(export / "surface.ply")["vertex"]
        box = self.scene["workspace"]
        self.workspace = np.array([box["min_m"], box["max_m"]])
        points = positions(surface)
        wanted = (surface["observable"] == 1) & ~support[surface["label"]] & in_box(points, self.workspace)
        self.points = points[wanted]

    def near_objects(self, points, limit):
        """Distances to the objects, of the points that the objects' bounds do not rule out; elsewhere infinite."""
        corner = self.objects.reshape(-1, 3)
        low, high = corner.min(axis=0) - 2 * limit, corner.max(axis=0) + 2 * limit
        close = np.all((points >= low) & (points <= high), axis=1)
        result = np.full(len(points), math.inf)
        result[close] = distances(points[close], self.objects)
        return result


def check_mesh(rows, final, truth, mesh, voxel_m):
    missing = distances(truth.points, mesh)
    coverage, unsure = share(missing, voxel_m)
    rows.row("coverage", final["coverage"], coverage, unsure + 1e-9)

    def off_supports(points):
        to_supports = distances(points, truth.supports)
        kept = to_supports > voxel_m
        return np.minimum(to_supports[kept], distances(points[kept], truth.objects))

    points = spread_points(mesh, truth.scene["surface"]["spacing_m"], truth.workspace)
    wrong = off_supports(points)
    if len(wrong) == 0:
        for name in ["accuracy_m", "chamfer_m", "f_score"]:
            rows.row(name, final[name], None)
        return
    accuracy = float(wrong.mean())
    rows.row("accuracy_m", final["accuracy_m"], accuracy, LENGTH_TOLERANCE_M)
    rows.row("chamfer_m", final["chamfer_m"], 0.5 * (accuracy + float(missing.mean())), LENGTH_TOLERANCE_M)
    precision, unsure_p = share(wrong, F_SCORE_M)
    recall, unsure_r = share(missing, F_SCORE_M)
    f_score = 2 * precision * recall / (precision + recall) if precision + recall > 0 else 0.0
    rows.row("f_score", final["f_score"], f_score, 2 * (unsure_p + unsure_r) + 1e-6)
    # Once more with points at random: five standard errors are allowed.
    wrong = off_supports(random_points(mesh, len(points) // 4 + 1, truth.workspace))
    if len(wrong) > 0:
        rows.row("accuracy_m, random points", final["accuracy_m"], float(wrong.mean()),
                 5 * float(wrong.std()) / math.sqrt(len(wrong)) + 1e-5)


def check_voxels(rows, final, truth, states):
    unknown = states.centers(states.state == 0)
    unknown = unknown[in_box(unknown, truth.workspace)]
    rows.row("unknown_left", final["unknown_left"], len(unknown))
    d = truth.near_objects(unknown, NEAR_OBJECTS_M)
    candidate = d <= NEAR_OBJECTS_M + TOO_CLOSE_M
    unknown, d = unknown[candidate], d[candidate]
    solid = np.zeros(len(unknown), dtype=bool)
    for body in truth.bodies:
        solid |= inside(unknown, body)
    on_surface = np.minimum(d, distances(unknown, truth.supports)) <= TOO_CLOSE_M
    unsure = on_surface | (~solid & (np.abs(d - NEAR_OBJECTS_M) <= TOO_CLOSE_M))
    near = ~solid & (d <= NEAR_OBJECTS_M)
    rows.row("unknown_near_objects", final["unknown_near_objects"], int(near.sum()), float(unsure.sum()))


def check_last_view(rows, result, truth, states, before):
    """points_at_object of the last view, from the map as it was one view earlier."""
    earlier, view = load_result(before), result["views"][-1]
    same = earlier["scene"] == result["scene"] and earlier["initial"] == result["initial"]
    same = same and [v["T_world_camera"] for v in [*earlier["views"], view]] == [v["T_world_camera"]
                                                                                 for v in result["views"]]
    states_before = States(before)
    if not same or states_before.first != states.first or states_before.state.shape != states.state.shape:
        raise Mismatch(f"{before}: is not the same exploration, ended one view earlier")
    known = states.centers((states.state != 0) & (states_before.state == 0))
    d = truth.near_objects(known, AT_OBJECT_M)
    near = np.count_nonzero(d <= AT_OBJECT_M)
    print(f"view {len(result['views'])} made {len(known)} voxels known, {near} of them near objects")
    unsure = np.count_nonzero(np.abs(d - AT_OBJECT_M) <= TOO_CLOSE_M)
    if 4 * (near - unsure) < len(known) <= 4 * (near + unsure) and unsure > 0:
        print("points_at_object: too close to tell")
        return
    rows.row("points_at_object, last view", view["points_at_object"], len(known) > 0 and bool(4 * near >= len(known)))


def check(run, export, before):
    result, truth, states = load_result(run), Truth(export), States(run)
    if truth.scene["scene"] != result["scene"]:
        raise Mismatch(f"{export}: is of scene {truth.scene['scene']}, and the run of {result['scene']}")
    if truth.scene["surface"]["spacing_m"] != result["truth_spacing_m"]:
        raise Mismatch(f"{export}: export the scene with --spacing {result['truth_spacing_m']}, as the run has it")
    final, views = result["final"], result["views"]
    rows = Comparison()
    rows.row("voxel_size_m", result["voxel_size_m"], states.edge_m)
    check_mesh(rows, final, truth, corners(read_ply(run / "mesh.ply")), states.edge_m)
    check_voxels(rows, final, truth, states)
    if views:
        for name in ["coverage", "unknown_left", "unknown_near_objects"]:
            rows.row(f"{name}, last view", views[-1][name], final[name])
    for view in views:
        turn = np.array(view["T_world_camera"])[:3, :3]
        rows.row(f"pose of view {view['index'] + 1}, rigid", 0.0, float(np.abs(turn @ turn.T - np.eye(3)).max()), 1e-6)
    if before is not None:
        if not views:
            raise Mismatch(f"{run}: has no view that could be compared with the map before it")
        check_last_view(rows, result, truth, states, before)
    return rows.good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", metavar="RUN", type=pathlib.Path)
    parser.add_argument("export", metavar="EXPORT", type=pathlib.Path)
    parser.add_argument("--before", metavar="RUN_K", type=pathlib.Path,
                        help="the same exploration, one view shorter: points_at_object of RUN's last view is checked too")
    options = parser.parse_args()
    try:
        good = check(options.run, options.export, options.before)
    except (Mismatch, OSError, KeyError, ValueError) as error:
        print(f"check_metrics: {type(error).__name__}: {error}", file=sys.stderr)
        sys.exit(2)
    print("all figures agree" if good else "figures differ")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
