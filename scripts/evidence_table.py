#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/results/evidence.md from what scripts/evidence.sh left: evidence_table.py RESULTS DOCUMENT."""
import json
import pathlib
import platform
import re
import statistics
import sys

import evidence_annotation
import evidence_surfels

# Limits of the measures, per step: (name in the JSON result, limit, "at most" or "at least", unit, factor).
LIMITS = {
    "fuse_rgbd_redkitchen_forced": [("depth_residual_m.median", 0.008, "at most"),
                                    ("depth_residual_m.share", 0.9, "at least")],
    "fuse_rgbd_redkitchen_icp": [("trajectory_error_m.aligned_rmse", 0.012, "at most"),
                                 ("trajectory_error_m.first_pose_rmse", 0.030, "at most"), ("lost", 0, "at most")],
}
SHOWN = ["frames", "lost", "depth_residual_m.median", "depth_residual_m.share", "trajectory_error_m.aligned_rmse",
         "trajectory_error_m.first_pose_rmse", "ms_per_frame.track.median", "ms_per_frame.integrate.median",
         "ms_per_frame.raycast.median", "map.bricks", "map.bytes", "peak_rss_bytes"]


def look_up(result, path):
    for key in path.split("."):
        if not isinstance(result, dict) or key not in result:
            return None
        result = result[key]
    return result


def shown(path, value):
    if value is None:
        return "–"
    if path.endswith("bytes"):
        return f"{value / 2**20:.0f} MiB"
    if "_m." in path and not path.endswith("share"):
        return f"{1000 * value:.1f} mm"
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def processor():
    match = re.search(r"model name\s*:\s*(.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return match.group(1) if match else platform.machine()


def command_of(folder, name):
    path = folder / f"{name}.command"
    return path.read_text().strip() if path.exists() else ""


def fuse_section(folder, lines):
    results = {path.stem: json.loads(path.read_text()) for path in sorted(folder.glob("fuse_*.json"))}
    held = True
    lines += ["## Recorded sequences", ""]
    for name, document in results.items():
        lines += [f"`{command_of(folder, name)}` ({document.get('threads')} threads)", "", "| figure | value | held to |",
                  "|---|---|---|"]
        limits = {path: (limit, sense) for path, limit, sense in LIMITS.get(name, [])}
        for path in SHOWN:
            value = look_up(document["result"], path)
            verdict = ""
            if path in limits:
                limit, sense = limits[path]
                good = value is not None and (value <= limit if sense == "at most" else value >= limit)
                held = held and good
                verdict = f"{sense} {shown(path, limit)}: {'yes' if good else 'NO'}"
            lines.append(f"| `{path}` | {shown(path, value)} | {verdict} |")
        lines.append("")
    return held


def color_section(folder, lines):
    path = folder / "color_agreement.log"
    if (folder / "color_agreement.done").exists():
        lines += ["## Poses beside colour images", "", f"`{command_of(folder, 'color_agreement')}`", "",
                  "How far points of a frame lie from where poses and depths put them in the image 30 frames later, median; what it",
                  "says is in [tracking](../guides/tracking.md).", "", path.read_text().rstrip(), ""]


def nbv_section(folder, lines):
    documents = [json.loads(path.read_text()) for path in sorted(folder.glob("nbv_*.json"))]
    if not documents:
        return True
    totals = [sum(d["result"]["ms"].values()) for d in documents]
    result = documents[0]["result"]
    good = statistics.median(totals) <= 2000
    lines += ["## View evaluation", "", f"`{command_of(folder, 'nbv_redkitchen_1')}`", "",
              f"{result['evaluated']} of {result['candidates']} poses evaluated, {result['rays_cast']} rays cast; prepare "
              f"and evaluate together, median of {len(totals)} runs: {statistics.median(totals):.0f} ms "
              f"(held to at most 2000 ms: {'yes' if good else 'NO'}); best gain {result['views'][0]['gain']}.", ""]
    return good


def reproduce_section(folder, lines):
    for step, title in (("reproduce", "Tables of the thesis"), ("reproduce_views", "Figures of the thesis, view by view")):
        if (folder / f"{step}.done").exists():
            log = (folder / f"{step}.log").read_text().rstrip()
            lines += [f"## {title}", "", f"`{command_of(folder, step)}`", "", log, ""]


def compare_section(folder, lines):
    path = folder / "compare.json"
    if not path.exists():
        return True
    result = json.loads(path.read_text())["result"]
    apart = {(gap["scene"], gap["b"]): gap["apart"] for gap in result["gaps"]}
    summaries = {(s["scene"], s["strategy"]): s for s in result["summaries"] if s["scene"] is not None}  # null: all scenes
    held = True
    lines += ["## Explorations", "", f"`{command_of(folder, 'compare')}`", "",
              "Coverage in per cent, mean and 95 % confidence interval. Held to: at most 60 after the scan, sphere at least "
              "90 at the end, random with as many views below it with the intervals apart.", "",
              "| scene | runs | after the scan | sphere | views | random | held |", "|---|---|---|---|---|---|---|"]

    def interval(estimate):
        mean, low = 100 * estimate["mean"], estimate["low"]
        return f"{mean:.1f}" + ("" if low is None else f" ± {mean - 100 * low:.1f}")

    for (scene, strategy), sphere in summaries.items():
        random = summaries.get((scene, "random"))
        if strategy != "sphere" or random is None:
            continue
        missed = []
        if sphere["initial_coverage"]["mean"] > 0.6:
            missed.append("scan")
        if sphere["coverage"]["mean"] < 0.9:
            missed.append("sphere")
        if not apart[scene, "random"] or random["coverage"]["mean"] >= sphere["coverage"]["mean"]:
            missed.append("random")
        held = held and not missed
        lines.append(f"| {scene} | {sphere['coverage']['n']} | {interval(sphere['initial_coverage'])} | "
                     f"{interval(sphere['coverage'])} | {sphere['views']['mean']:.1f} | {interval(random['coverage'])} | "
                     f"{'yes' if not missed else 'NO: ' + ', '.join(missed)} |")
    lines.append("")
    return held


def mean_text(estimate, scale=1.0, decimals=1):
    if estimate["mean"] is None:
        return "–"
    mean, low = scale * estimate["mean"], estimate["low"]
    return f"{mean:.{decimals}f}" + ("" if low is None else f" ± {mean - scale * low:.{decimals}f}")


def attention_rows(summaries, lines):
    lines += ["| scene | strategy | object-directed of 5 | axis at object of 5 | unknown near after 5 | coverage, % | area, % |",
              "|---|---|---|---|---|---|---|"]
    for summary in summaries:
        lines.append(f"| {summary['scene'] or 'all'} | {summary['strategy']} | {mean_text(summary['object_views'])} | "
                     f"{mean_text(summary['looking_views'])} | {mean_text(summary['unknown_near_objects_at_5'], 1.0, 0)} | "
                     f"{mean_text(summary['coverage'], 100.0)} | {mean_text(summary['coverage_area'], 100.0)} |")
    lines.append("")


def attention_section(folder, lines):
    """Object-directed views, unknown space and area of the strategies; what the thesis claims, where it holds and where not."""
    path = folder / "attention.json"
    if not path.exists():
        return True
    result = json.loads(path.read_text())["result"]
    lines += ["## Attention beside others", "", f"`{command_of(folder, 'attention')}`", "",
              "Mean and 95 % confidence interval. *Object-directed*: a quarter of what a view made known lies at objects; *axis at "
              "object*: the optical axis meets one ([metrics](../reference/metrics.md)).", ""]
    scenes = [s for s in result["summaries"] if s["scene"] is not None]
    attention_rows(scenes, lines)
    of = {(s["scene"], s["strategy"]): s for s in scenes}
    apart = {(g["scene"], g["b"]): g["unknown_near_objects_at_5"] for g in result["gaps"] if g["a"] == "attention"}
    lines += ["Held to, scene by scene: 70 % of attention's first five views point towards the objects, as Table 3.3 of the thesis "
              "marks them (by the axis; by newly known voxels, which is stricter, beside it); fewer unknown voxels near the objects "
              "than standard, the intervals apart (the difference seed by seed beside it); 85 % of the oracle's area.", "",
              "| scene | views at objects, % | by newly known voxels | fewer unknown than standard | difference by seed | "
              "share of the oracle's area, % |",
              "|---|---|---|---|---|---|"]
    held = True

    def percent(value, least):
        return f"{value:.0f}" + ("" if value >= least else " NO")

    for scene in dict.fromkeys(s["scene"] for s in scenes):
        attention, standard, oracle = (of[scene, name] for name in ("attention", "standard", "oracle"))
        axis, marks = 20 * attention["looking_views"]["mean"], 20 * attention["object_views"]["mean"]
        near, other = attention["unknown_near_objects_at_5"], standard["unknown_near_objects_at_5"]
        fewer = near["high"] is not None and near["high"] < other["low"]
        area = 100 * attention["coverage_area"]["mean"] / oracle["coverage_area"]["mean"]
        held = held and axis >= 70 and fewer and area >= 85
        lines.append(f"| {scene} | {percent(axis, 70)} | {percent(marks, 70)} | {'yes' if fewer else 'NO'} | "
                     f"{mean_text(apart[scene, 'standard'], 1.0, 0)} | {percent(area, 85)} |")
    lines.append("")
    clutter = folder / "attention_clutter.json"
    if clutter.exists():
        result = json.loads(clutter.read_text())["result"]
        lines += ["Thirty scenes of random clutter, each counted once:", "", f"`{command_of(folder, 'attention_clutter')}`", ""]
        attention_rows([s for s in result["summaries"] if s["scene"] is None], lines)
    return held


def update_section(folder, lines):
    """Both experiments of the thesis' section 2.4.3, over seeds."""
    held = True
    rows = []
    for scene in ["bottle", "jug"]:
        for when in ["viewpoints", "motion"]:
            paths = sorted(folder.glob(f"update_{scene}_{when}_*.json"))
            if not paths:
                continue
            results = [json.loads(path.read_text())["result"] for path in paths]
            regions = [region for result in results for region in result["regions"]]
            complete = sum(region["end"] == "done" for region in regions)
            unreachable = sum(region["end"] == "out_of_reach" for region in regions)
            surfaces = [region["coverage"]["surfaces"] for region in regions]
            errors = [abs(value) for result in results for thing in result["objects"] for value in
                      (thing["error"] or {"missing": float("inf")}).values()]
            touching = sum(result["contacts"]["touching"] for result in results)
            home = all(result["back"]["at_stand_by"] for result in results)
            missed = []
            if complete + unreachable < len(regions) or not regions:
                missed.append("regions")
            if min(surfaces) < 0.9:
                missed.append("surface")
            if max(errors) > 0.008:
                missed.append("shape")
            if touching or not home:
                missed.append("arm")
            held = held and not missed
            views = [len(result["views"]) for result in results]
            robot = statistics.mean(result["phases_s"]["robot"] for result in results)
            rows.append(f"| {scene} | {when} | {len(results)} | {complete} of {len(regions)} | {unreachable} | "
                        f"{min(views)}–{max(views)} | {100 * min(surfaces):.1f} | {100 * statistics.mean(surfaces):.1f} | "
                        f"{1000 * max(errors):.1f} | {1000 * statistics.mean(errors):.1f} | {touching} | {robot:.1f} | "
                        f"{'yes' if not missed else 'NO: ' + ', '.join(missed)} |")
    if rows:
        lines += ["## Updates", "", f"`{command_of(folder, 'update_bottle_viewpoints_1')}`, and so on.", "",
                  "Surface: share of what can be seen inside a region, table included, that the mesh has within a voxel, in "
                  "per cent, least and mean of all regions. Error: of height and both axes of the object that was put down, "
                  "millimetres, largest and mean. Held to: every region complete (those out of reach are counted apart), "
                  "surface at least 90, error at most 8 mm, no contact of the arm with what is really there, the arm back "
                  "at its stand-by.", "",
                  "| scene | fused | seeds | complete | out of reach | views | surface, least | mean | error, largest | mean "
                  "| contacts | arm's motion, s | held |", "|---|---|---|---|---|---|---|---|---|---|---|---|---|", *rows, ""]
    return held


def log_section(folder, lines, name, title, text, shown_line):
    """The lines of a test's output that are worth showing."""
    log = folder / f"{name}.log"
    if not log.exists():
        return
    lines += [f"## {title}", "", f"`{command_of(folder, name)}`", "", *text, ""]
    lines += ["- " + line for line in log.read_text().splitlines() if shown_line(line)] + [""]


def arm_section(folder, lines):
    log_section(folder, lines, "arm_collision", "Arm collisions", [
        "Beside FCL with a box per obstacle cell: random configurations anywhere, and as many apart that are within 5 cm",
        "of contact. The step fails where an arm is called free and FCL finds a contact, or where more than 5 % of the",
        "free ones anywhere are called contacts."], lambda line: " configurations, " in line)


def planning_section(folder, lines):
    shown = ("scenes ", "configurations looked at", "straight: ", "search: ", "duration: ")
    log_section(folder, lines, "motion_planning", "Motion planning", [
        "The built-in arm in the built-in scenes as they are known after the scan and four views; supports and fixtures",
        "are boxes. A quarter of the pairs goes to a view by any of its configurations, the others to one",
        "configuration that no straight motion leads to. FCL looks at every trajectory each 2 ms, or oftener, so that",
        "no point of the arm moves farther than 2 mm; the step fails where it finds a collision. One thread."],
        lambda line: line.startswith(shown))


def kill_section(folder, lines):
    log_section(folder, lines, "annotation_kills", "Annotation sessions", [
        "Processes that annotate are killed (SIGKILL) at random instants, and their session is opened again. The step fails",
        "unless it holds every action that was acknowledged, at most the one at hand beyond, and the state that they leave."],
        lambda line: " processes killed: " in line)


def page_section(folder, lines):
    log_section(folder, lines, "browser_large", "The annotation page", [
        "A cloud of ten million points in Chromium, drawn by software. The step fails unless the first picture is there 10 s",
        "after the page is asked for, and fails where memory is not bounded as `web/tests/large.spec.ts` says."],
        lambda line: " points: the program listens after " in line)


def fuzz_section(folder, lines):
    logs = sorted(folder.glob("fuzz_*.log"))
    if not logs:
        return
    lines += ["## Fuzzing", "", "| target | outcome |", "|---|---|"]
    for path in logs:
        match = re.search(rf"^  {path.stem}: (.*)$", path.read_text(), re.MULTILINE)
        lines.append(f"| `{path.stem}` | {match.group(1) if match else 'failed'} |")
    lines.append("")


def main():
    folder, document = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    lines = ["# Evidence", "", "Written by `make evidence`; what the figures mean is in [metrics](../reference/metrics.md). "
             f"Machine: {processor()}.", ""]
    held = fuse_section(folder, lines)
    color_section(folder, lines)
    held = nbv_section(folder, lines) and held
    reproduce_section(folder, lines)
    held = compare_section(folder, lines) and held
    held = attention_section(folder, lines) and held
    held = update_section(folder, lines) and held
    arm_section(folder, lines)
    planning_section(folder, lines)
    held = evidence_surfels.section(folder, lines, command_of) and held
    held = evidence_surfels.gain_section(folder, lines, command_of) and held
    log_section(folder, lines, "surfel_growth", "Surfels of the same spot", evidence_surfels.GROWTH_TEXT,
                lambda line: line.startswith("growth: "))
    log_section(folder, lines, "surfel_sharpness", "Surfels on recorded frames", evidence_surfels.SHARPNESS_TEXT,
                lambda line: line.startswith("sharpness: "))
    held = evidence_annotation.annotation_section(folder, lines, command_of) and held
    held = evidence_annotation.scan_section(folder, lines, command_of) and held
    kill_section(folder, lines)
    page_section(folder, lines)
    fuzz_section(folder, lines)
    document.write_text("\n".join(lines))
    if not held:
        print("some figures are not held, see docs/results/evidence.md", file=sys.stderr)
    sys.exit(0 if held else 1)


if __name__ == "__main__":
    main()
