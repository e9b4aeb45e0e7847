#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The example draws its figure. Skipped where matplotlib is not there."""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]

try:
    import matplotlib.image
except ImportError as error:
    print(f"skipped: {error.name} is not there (packages.txt, tests)")
    sys.exit(77)

with tempfile.TemporaryDirectory() as folder:
    picture = pathlib.Path(folder) / "figure.png"
    subprocess.run([sys.executable, "-B", str(ROOT / "examples/figure_3_17.py"), str(picture), "--scenes", "clutter:1",
                    "--seeds", "1", "--views", "1"], check=True)
    pixels = matplotlib.image.imread(picture)
assert pixels.shape[0] > 300 and pixels.shape[1] > 400, pixels.shape
colors = {tuple(color) for color in (pixels[:, :, :3].reshape(-1, 3) * 255).round().astype(int).tolist()}
for line in ((31, 119, 180), (255, 127, 14), (44, 160, 44)):
    assert line in colors, f"the line of colour {line} is missing"
