#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Explorations on surfels beside those on a volume: coverage, accuracy, memory of the map and time a view, as a table.
The scenes and seeds were chosen before anything was measured; a run ends by the program's own rule, or after 8 views.
Usage: evidence_maps.py PROGRAM FOLDER [SCENE,… SEED,…]"""
import json
import pathlib
import subprocess
import sys

SCENES = ["tabletop-1", "tabletop-2", "clutter:101", "clutter:102"]
SEEDS = [1, 2]
KINDS = {"volume": [], "surfels": ["--map", "surfels"]}
VIEWS = 8
PLANNER = ["candidates", "saliency", "reachability", "evaluation"]  # phases in which a view is chosen, motions apart


def run(program, folder, scene, seed, kind):
    """Explores once and returns the result; what was done before is read again."""
    out = folder / f"{scene.replace(':', '-')}-{seed}-{kind}"
    result = out.with_suffix(".json")
    if not result.exists():
        command = [program, "--quiet", "--seed", str(seed), "explore", scene, "--max-views", str(VIEWS), "--no-pictures",
                   "--force", "--out", str(out), "--json", str(result), *KINDS[kind]]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return json.loads(result.read_text())["result"]


def coverage_after(result, views):
    taken = result["views"][:views]
    return (taken[-1] if taken else result["initial"])["coverage"]


def row(name, seed, kind, result):
    views = result["views"]
    phases = result["phases_s"]
    count = max(1, len(views))
    final = result["final"]
    chosen_ms = 1e3 * sum(phases.get(phase, 0.0) for phase in PLANNER) / count
    fused_ms = 1e3 * phases.get("fusion", 0.0) / count
    memory = result["map"]
    return {"name": name, "seed": seed, "kind": kind, "views": len(views), "c2": coverage_after(result, 2),
            "c4": coverage_after(result, 4), "end": final["coverage"], "accuracy_mm": 1e3 * final["accuracy_m"],
            "f_score": final["f_score"], "memory_mib": memory["memory_bytes"] / 2**20,
            "voxels_mib": memory["voxels_bytes"] / 2**20, "surfels": memory.get("surfels", 0), "chosen_ms": chosen_ms,
            "fused_ms": fused_ms}


def text(r):
    return (f"| {r['name']} | {r['seed']} | {r['kind']} | {r['views']:g} | {100 * r['c2']:.1f} | {100 * r['c4']:.1f} | "
            f"{100 * r['end']:.1f} | {r['accuracy_mm']:.2f} | {r['f_score']:.3f} | {r['memory_mib']:.1f} | "
            f"{r['voxels_mib']:.1f} | {r['chosen_ms']:.0f} | {r['fused_ms']:.0f} |")


def mean_of(rows, kind):
    chosen = [r for r in rows if r["kind"] == kind]
    mean = {key: sum(r[key] for r in chosen) / len(chosen) for key, value in chosen[0].items() if not isinstance(value, str)}
    return mean | {"name": "mean", "seed": "", "kind": kind, "views": round(mean["views"], 1)}


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    scenes, seeds = (argument.split(",") for argument in sys.argv[3:5]) if len(sys.argv) > 4 else (SCENES, SEEDS)
    rows = []
    for scene in scenes:
        for seed in seeds:
            for kind in KINDS:  # one after the other, so that a busy machine is busy for both
                rows.append(row(scene, seed, kind, run(program, folder, scene, seed, kind)))
    print("| scene | seed | map | views | coverage after 2, % | after 4 | at the end | accuracy, mm | F-score at 5 mm | "
          "memory, MiB | of which voxels | a view chosen, ms | fused, ms |\n" + "|---" * 13 + "|")
    for r in rows + [mean_of(rows, kind) for kind in KINDS]:
        print(text(r))
    # A run that covers next to nothing is broken, whatever the other one does.
    wrong = [r for r in rows if r["end"] < 0.5]
    for r in wrong:
        print(f"{r['name']}, seed {r['seed']}, {r['kind']}: only {100 * r['end']:.1f} % covered")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
