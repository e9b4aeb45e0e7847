#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the Python of docs/guides/python.md, block after block."""
import pathlib
import re

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs/guides/python.md"

blocks = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(), re.DOTALL | re.MULTILINE)
assert len(blocks) >= 2, "the guide has lost its examples"
names = {}
for block in blocks:
    exec(compile(block, str(PAGE), "exec"), names)
assert names["states"].shape == (60, 100, 100) and names["gains"].shape == (960,)
assert {row["strategy"] for row in names["result"]["summary"]} == {"sphere", "by-distance"}
assert len(names["record"]["views"]) == 2 and names["camera"].measure(names["m"])["coverage"] > 0.5
assert len(names["desk"].mesh()["vertices"]) > 1000 and names["labels"].max() == len(names["saliency"]) > 3
assert names["clicked"][names["near"]] == 3 and names["clicked"][names["far"]] == 1
