# SPDX-License-Identifier: Apache-2.0
"""Plots as SVG, readable on light and dark pages: lines and bars on logarithmic axes."""
import html
import math

WIDTH, HEIGHT = 640, 340
LEFT, RIGHT, TOP, BOTTOM = 70, 190, 40, 56
STYLE = """<style>
text { font: 13px system-ui, sans-serif; fill: #24292f }
.title { font-size: 14px; font-weight: 600 }
.page { fill: #ffffff } .grid { stroke: #d0d7de; stroke-width: 1 } .axis { stroke: #57606a; stroke-width: 1 }
.a { stroke: #0969da; fill: #0969da } .b { stroke: #bc4c00; fill: #bc4c00 } .c { stroke: #1a7f5a; fill: #1a7f5a }
polyline { fill: none !important; stroke-width: 2 }
@media (prefers-color-scheme: dark) {
  text { fill: #e6edf3 }
  .page { fill: #0d1117 } .grid { stroke: #30363d } .axis { stroke: #8b949e }
  .a { stroke: #58a6ff; fill: #58a6ff } .b { stroke: #f0883e; fill: #f0883e } .c { stroke: #3fb68b; fill: #3fb68b }
}
</style>"""
CLASSES = "abc"


def number(value):
    return f"{value:,.0f}" if value >= 10 else f"{value:g}"


def text(x, y, content, anchor="middle", extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{extra}>{html.escape(content)}</text>'


def write(path, width, height, title, parts):
    path.parent.mkdir(parents=True, exist_ok=True)
    body = "\n".join(parts)
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
                    f'height="{height}" role="img" aria-label="{html.escape(title)}">\n<!-- SPDX-License-Identifier: '
                    f'Apache-2.0 -->\n{STYLE}\n<rect class="page" width="{width}" height="{height}" rx="6"/>\n'
                    f'{heading(title)}\n{body}\n</svg>\n')


def heading(title):
    return text(16, 24, title, "start", ' class="title"')


class LogScale:
    """Values to pixels, by their logarithm."""

    def __init__(self, low, high, begin_px, end_px):
        self.low, self.begin_px = math.log(low), begin_px
        self.per_unit = (end_px - begin_px) / max(math.log(high) - self.low, 1e-9)

    def __call__(self, value):
        return self.begin_px + (math.log(value) - self.low) * self.per_unit


def ticks(low, high):
    """1, 2, 5, 10 … within the range; without 2 and 5 where there are many."""
    steps = (1, 2, 5) if high / low < 200 else (1,)
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    return [step * 10.0**power for power in powers for step in steps if low * 0.999 <= step * 10.0**power <= high * 1.001]


def exponent(points):
    """Returns the exponent of the power law through the points, by least squares of the logarithms."""
    xs, ys = [math.log(x) for x, _ in points], [math.log(y) for _, y in points]
    x_mean, y_mean = sum(xs) / len(xs), sum(ys) / len(ys)
    return (sum((x - x_mean) * (y - y_mean) for x, y in zip(xs, ys)) / sum((x - x_mean)**2 for x in xs))


def apart(places, least):
    """Labels moved down until they do not overlap; in the order of their places."""
    moved = []
    for y in sorted(places):
        moved.append(max(y, moved[-1] + least) if moved else y)
    overshoot = moved[-1] - (HEIGHT - BOTTOM) if moved else 0.0
    return [y - max(overshoot, 0.0) for y in moved]


def marker(index, x, y):
    name = CLASSES[index]
    if index == 0:
        return f'<circle class="{name}" cx="{x:.1f}" cy="{y:.1f}" r="4"/>'
    if index == 1:
        return f'<rect class="{name}" x="{x - 3.5:.1f}" y="{y - 3.5:.1f}" width="7" height="7"/>'
    return f'<path class="{name}" d="M{x:.1f} {y - 5:.1f}l5 9h-10z"/>'


def lines(path, title, x_label, series):
    """Series: (label, [(x, ms)]), at most three; each is labelled where it ends, with its exponent."""
    series = [(label, points) for label, points in series if len(points) > 1]
    if not series:
        return False
    xs = sorted({x for _, points in series for x, _ in points})
    values = [y for _, points in series for _, y in points]
    low, high = min(values) / 1.3, max(values) * 1.3
    if high / low < 10:  # never so narrow that noise looks like a law
        middle = math.sqrt(low * high)
        low, high = middle / math.sqrt(10), middle * math.sqrt(10)
    to_x = LogScale(xs[0], xs[-1], LEFT + 14, WIDTH - RIGHT)
    to_y = LogScale(low, high, HEIGHT - BOTTOM, TOP)
    parts = []
    for tick in ticks(low, high):
        y = to_y(tick)
        parts.append(f'<line class="grid" x1="{LEFT}" x2="{WIDTH - RIGHT + 8}" y1="{y:.1f}" y2="{y:.1f}"/>')
        parts.append(text(LEFT - 8, y + 4, number(tick), "end"))
    for x in xs:
        at = to_x(x)
        parts.append(f'<line class="axis" x1="{at:.1f}" x2="{at:.1f}" y1="{HEIGHT - BOTTOM}" y2="{HEIGHT - BOTTOM + 5}"/>')
        parts.append(text(at, HEIGHT - BOTTOM + 20, f"{x:,g}"))
    parts.append(f'<path class="axis" fill="none" d="M{LEFT} {TOP}V{HEIGHT - BOTTOM}H{WIDTH - RIGHT + 8}"/>')
    parts.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 14, x_label))
    middle = (TOP + HEIGHT - BOTTOM) / 2
    parts.append(text(20, middle, "ms", "middle", f' transform="rotate(-90 20 {middle:.1f})"'))
    ends = sorted((to_y(points[-1][1]), index) for index, (_, points) in enumerate(series))
    for (_, index), y in zip(ends, apart([y for y, _ in ends], 34)):
        label, points = series[index]
        parts.append(text(WIDTH - RIGHT + 16, y + 1, label, "start"))
        parts.append(text(WIDTH - RIGHT + 16, y + 16, f"exponent {exponent(points):.2f}".replace("-", "−"), "start"))
    for index, (_, points) in enumerate(series):
        path_points = " ".join(f"{to_x(x):.1f},{to_y(y):.1f}" for x, y in points)
        parts.append(f'<polyline class="{CLASSES[index]}" points="{path_points}"/>')
        parts += [marker(index, to_x(x), to_y(y)) for x, y in points]
    write(path, WIDTH, HEIGHT, title, parts)
    return True


def bars(path, title, rows, unit):
    """Rows: (label, value), from above; the axis is logarithmic."""
    left, row_px, width = 160, 28, WIDTH
    height = 52 + row_px * len(rows) + 40
    low = 10.0**math.floor(math.log10(min(value for _, value in rows)) - 0.3)
    high = 10.0**math.ceil(math.log10(max(value for _, value in rows)))
    to_x = LogScale(low, high, left, width - 90)
    bottom = 46 + row_px * len(rows)
    parts = []
    for tick in ticks(low, high):
        x = to_x(tick)
        parts.append(f'<line class="grid" x1="{x:.1f}" x2="{x:.1f}" y1="40" y2="{bottom}"/>')
        parts.append(text(x, bottom + 18, number(tick)))
    for index, (label, value) in enumerate(rows):
        y = 46 + row_px * index
        parts.append(f'<rect class="a" x="{left}" y="{y}" width="{max(to_x(value) - left, 1):.1f}" height="{row_px - 8}"/>')
        parts.append(text(left - 8, y + 15, label, "end"))
        parts.append(text(to_x(value) + 8, y + 15, number(round(value)), "start"))
    parts.append(text((left + width - 90) / 2, height - 8, unit))
    write(path, width, height, title, parts)
