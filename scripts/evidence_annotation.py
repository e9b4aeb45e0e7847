# SPDX-License-Identifier: Apache-2.0
"""Sections of docs/results/evidence.md about simulated annotators, used by evidence_table.py."""
import json
import pathlib

ROOM_FLOOR = {"three": 0.95, "six": 0.98, "falls": 1}
STREET_FLOOR = {"three": 0.95, "six": 0.98, "falls": 1}


def greatest_fall(curve):
    """Below the best value before: how much, and at which value it is (from 1)."""
    return max((max(curve[:n]) - curve[n], n + 1) for n in range(1, len(curve)))


def annotation_section(folder, lines, command_of):
    """Simulated annotators, by control points and by rectangles, with as many actions."""
    results = {}
    methods = ("control_points", "rectangles", "best_rectangles")
    for method in methods:
        path = folder / f"annotation_{method}.json"
        if not path.exists():
            return True
        results[method] = json.loads(path.read_text())["result"]
    clicks, rectangles, best = (results[method] for method in methods)
    lines += ["## Annotation", ""]
    for method in methods:
        lines += [f"`{command_of(folder, 'annotation_' + method)}`", ""]
    lines += [f"Simulated annotators on {clicks['mean']['clouds']} labelled clouds (mOSD); means over these. Control points are placed "
              "at the centre of the largest error, rectangles are drawn around it, in the best of six views, on the surface or "
              "through it. The best rectangles are those that correct most of all possible ones; users do not find them. Held to: "
              "mean IoU at least 0.90 at three clicks per label, the mean never more than 0.01 below what it was, rectangles worse "
              "with as many actions.", "",
              "| actions per label | control points: mean IoU | wrong of 100,000 | rectangles: mean IoU | wrong of 100,000 | worse | "
              "best rectangles: mean IoU | wrong of 100,000 |", "|---|---|---|---|---|---|---|---|"]
    curve = clicks["mean"]["per_label"]
    worse = True
    for ours, theirs, bests in zip(curve, rectangles["mean"]["per_label"], best["mean"]["per_label"]):
        is_worse = theirs["iou_mean"] < ours["iou_mean"]
        worse = worse and is_worse
        lines.append(f"| {ours['clicks']} | {ours['iou_mean']:.3f} | {ours['errors_per_100k']:.0f} | {theirs['iou_mean']:.3f} | "
                     f"{theirs['errors_per_100k']:.0f} | {'yes' if is_worse else 'NO'} | {bests['iou_mean']:.3f} | "
                     f"{bests['errors_per_100k']:.0f} |")
    lines += ["", "| mean IoU reached | control points | per label | clouds | rectangles | per label | clouds |",
              "|---|---|---|---|---|---|---|"]
    for goal, ours in clicks["mean"]["noc"].items():
        theirs = rectangles["mean"]["noc"][goal]
        lines.append(f"| {goal} % | " + " | ".join(
            f"{noc['clicks']:.1f} | {noc['clicks_per_label']:.2f} | {noc['reached']} of {noc['reached'] + noc['never']}"
            for noc in (ours, theirs)) + " |")
    fall, at = greatest_fall([step["iou_mean"] for step in curve])
    cloud_fall, cloud_at, name = max((*greatest_fall([step["iou_mean"] for step in cloud["clicks"]]), pathlib.Path(cloud["file"]).name)
                                     for cloud in clicks["clouds"])
    three = curve[2]["iou_mean"]
    lines += ["", f"- Mean IoU at three clicks per label: {three:.3f} (at least 0.90: {'yes' if three >= 0.9 else 'NO'}).",
              f"- Greatest fall of the mean, over numbers of clicks per label, below what it was: {max(fall, 0):.4f}"
              + (f", at {at} per label" if fall > 0 else "") + f" (at most 0.01: {'yes' if fall <= 0.01 else 'NO'}).",
              f"- Greatest fall of a single cloud at a single click: {cloud_fall:.3f}, {name}, click {cloud_at}. A click that takes "
              "more than it ought to is corrected by those after it.",
              f"- The thesis' user study: 26.5 control points for four objects and the background, 5.3 per label; 797 of 100,000 "
              f"points wrong, 2354 with rectangles. Here after five per label: {curve[4]['errors_per_100k']:.0f} and "
              f"{rectangles['mean']['per_label'][4]['errors_per_100k']:.0f}. Other clouds, and no person: "
              "`saccade reproduce 4.5 4.6` says what compares.", ""]
    return three >= 0.9 and fall <= 0.01 and worse


def scan_section(folder, lines, command_of):
    """Simulated annotators in made rooms and streets."""
    floors = {"room": ROOM_FLOOR, "street": STREET_FLOOR}
    rows, held = [], True
    for kind, floor in floors.items():
        path = folder / f"annotation_{kind}.json"
        if not path.exists():
            continue
        result = json.loads(path.read_text())["result"]
        curve = [step["iou_mean"] for step in result["mean"]["per_label"]]
        falls = [greatest_fall([step["iou_mean"] for step in cloud["clicks"]])[0] for cloud in result["clouds"]]
        far = sum(fall > 0.05 for fall in falls)
        fits = curve[2] >= floor["three"] and curve[5] >= floor["six"] and far <= floor["falls"]
        held = held and fits
        labels = [cloud["objects"] for cloud in result["clouds"]]
        points = [cloud["points"] for cloud in result["clouds"]]
        rows.append(f"| {kind} | {len(labels)} | {min(points)}–{max(points)} | {min(labels)}–{max(labels)} | "
                    + " | ".join(f"{curve[n - 1]:.3f}" for n in (1, 2, 3, 6)) + f" | {far} | {max(falls):.3f} | "
                    f"{floor['three']}, {floor['six']}, {floor['falls']}: {'yes' if fits else 'NO'} |")
    if rows:
        lines += ["## Annotation of made scans", "", f"`{command_of(folder, 'scan_room_1')}`, and so on; "
                  f"`{command_of(folder, 'annotation_room')}`, and so on.", "",
                  "Simulated annotators, by control points, on scans of a simulated laser scanner. A fall: a click that takes "
                  "more than 0.05 off the cloud's mean IoU. Held to: mean IoU at three and at six clicks per label, and "
                  "clouds with a fall.", "",
                  "| kind | clouds | points | labels | mean IoU at 1 | 2 | 3 | 6 | clouds with a fall | greatest fall | held to |",
                  "|---|---|---|---|---|---|---|---|---|---|---|", *rows, ""]
    return held
