#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the Python of README.md and of the guides, block after block."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(page, least):
    """Names after the last of the page's blocks, which go on from each other."""
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(), re.DOTALL | re.MULTILINE)
    assert len(blocks) >= least, f"{page} has lost its examples"
    names = {}
    for block in blocks:
        exec(compile(block, page, "exec"), names)
    return names


view = run("README.md", 1)["view"]
assert view["gain"] > 100 and view["T_world_camera"].shape == (4, 4) and view["T_world_camera"][2, 3] > 0
runs = run("docs/guides/compare-your-planner.md", 1)["result"]["runs"]
assert [r["strategy"] for r in runs] == ["sphere", "low-first"] * 2 and all(r["final"]["coverage"] > 0.5 for r in runs)
names = run("docs/guides/python.md", 5)
assert names["states"].shape == (60, 100, 100) and names["gains"].shape == (960,)
assert {row["strategy"] for row in names["result"]["summary"]} == {"sphere", "by-distance"}
assert len(names["record"]["views"]) == 2 and names["camera"].measure(names["m"])["coverage"] > 0.5
assert len(names["desk"].mesh()["vertices"]) > 1000 and names["labels"].max() == len(names["saliency"]) > 3
assert names["clicked"][names["near"]] == 3 and names["clicked"][names["far"]] == 1
