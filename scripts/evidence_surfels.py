# SPDX-License-Identifier: Apache-2.0
"""Figures of surfels and how well they are segmented, of docs/results/evidence.md: thesis §4.1.3."""
import json

SCENES = ("workshop-1", "workshop-2", "desk", "magazines-1", "magazines-2")
SEEDS = ((1, "surfels_"), (2, "surfels_seed_2_"))  # and what the steps' names begin with
SHARPNESS_TEXT = [
    "How steeply luminance rises where the camera's image has edges, in renderings of the averages and of the modes",
    "(docs/guides/surfels.md). The step fails unless modes are half as steep again, in every frame a third, and cover as much."]
GROWTH_TEXT = [
    "The step fails where surfels become more than a hundredth more after the first tenth of the frames, or memory more",
    "at all."]
ALGORITHMS = (("flood_fill", "4.10", "flood fill"), ("sv_lccp", "4.11", "SV-LCCP"))
FIGURES = (("least_bce", "least BCE", -1), ("best_f", "greatest F", 1), ("area", "area below the curve", 1))


def tables_of(folder, name):
    """Rows of the scene by the table's number, or None."""
    path = folder / f"{name}.json"
    if not path.exists():
        return None
    tables = json.loads(path.read_text())["result"]["tables"]
    return {table["table"]: table["rows"] for table in tables if "rows" in table}


def section(folder, lines, command_of):
    """Table 4.3 and Figs. 4.10 and 4.11 of all frames. Whether enhancement is better in every figure that is there."""
    steps = {(scene, seed): prefix + scene for seed, prefix in SEEDS for scene in SCENES}
    trials = {trial: tables for trial, name in steps.items() if (tables := tables_of(folder, name))}
    if not trials:
        return True
    lines += ["## Surfels, segmented", ""]
    lines += [f"`{command_of(folder, steps[trial])}`\n" for trial in trials]
    lines += ["Rendered scenes with noise, not enhanced → enhanced by the mode filter (docs/guides/surfel-segmentation.md). Held to: better in "
              "every figure. In brackets that of true colours: each surfel not enhanced, but in the one colour of the thing that it is "
              "on. Where that is worse than not enhanced, the figure rewards blur. Times are with whatever else the machine did; "
              "alone: docs/results/performance.md.", "", "| scene | seed | frames | surfels | ms per frame | algorithm | "
              + " | ".join(f"{title} | better" for _, title, _ in FIGURES) + " |",
              "|---|---|---|---|---|---|" + "---|---|" * len(FIGURES)]
    held = True
    for (scene, seed), tables in trials.items():
        about = tables["4.1"][0]
        for algorithm, number, title in ALGORITHMS:
            curves = tables[number][0]
            cells = []
            for figure, _, sense in FIGURES:
                average, modes, truth = (curves[cloud][figure] for cloud in ("not_enhanced", "enhanced", "true_colors"))
                better = sense * (modes - average) > 0
                held = held and better
                cells.append(f"{average:.3f} → {modes:.3f} ({truth:.3f}) | {'yes' if better else 'NO'}")
            lines.append(f"| {scene} | {seed} | {about['frames']} | {about['points']} | {about['ms_per_frame']:.1f} | {title} | "
                         + " | ".join(cells) + " |")
    lines.append("")
    return held


def gain_section(folder, lines, command_of):
    """Table 4.gain. Whether compensation wins back half of every loss, or more."""
    scenes = {scene: tables_of(folder, f"surfels_gain_{scene}") for scene in SCENES}
    scenes = {scene: tables["4.gain"] for scene, tables in scenes.items() if tables}
    if not scenes:
        return True
    lines += ["## Surfels with automatic gain", ""]
    lines += [f"`{command_of(folder, f'surfels_gain_{scene}')}`\n" for scene in scenes]
    lines += ["Enhanced by the mode filter, without gain, with it, and with exposure compensation (docs/guides/surfel-exposure.md). Held to: "
              "half of every loss is won back, or more.", "",
              "| scene | frames | algorithm | figure | gain off | on | on, compensated | loss won back | held |",
              "|---|---|---|---|---|---|---|---|---|"]
    held = True
    for scene, rows in scenes.items():
        for key, _, algorithm in ALGORITHMS:
            for figure in rows[0][key]:
                won = figure["won_back"]
                fits = won is None or won >= 0.5
                held = held and fits
                lines.append(f"| {scene} | {rows[0]['frames']} | {algorithm} | {figure['figure']} | {figure['off']:.3f} | {figure['on']:.3f} "
                             f"| {figure['compensated']:.3f} | {'no loss' if won is None else f'{100 * won:.0f} %'} "
                             f"| {'yes' if fits else 'no'} |")
    lines.append("")
    return held
