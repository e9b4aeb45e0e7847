# SPDX-License-Identifier: Apache-2.0
"""The physical bound of each row: what must be moved, computed and looked up at least, at the rates of this machine."""
from performance.results import figure

PIXELS = 640 * 480
VOXELS = 512  # voxels of a brick
DENSE_BRICK = VOXELS * 4 + 2 * VOXELS // 8  # bytes: value and weight per voxel, two masks
FREE_BRICK = 3 * VOXELS // 8  # bytes
CACHE_LINE = 64
# What is used up, and which row of bench/machine.cpp measures its rate.
RESOURCES = {"memory": ("read_memory", "bytes_per_second"), "cache": ("read_cache", "bytes_per_second"),
             "arithmetic": ("multiply_and_add", "items_per_second"), "look-ups": ("look_up", "items_per_second")}
UNITS = {"memory": "MB", "cache": "MB", "arithmetic": "M operations", "look-ups": "M look-ups"}


def rates(results, threads):
    return {resource: results.counter(f"machine:{row}/threads:{threads}", counter)
            for resource, (row, counter) in RESOURCES.items()}


def fusion(frame):
    surface, updated = frame("surface_bricks"), frame("bricks_updated")
    voxels = updated * VOXELS
    return ({"memory": 4 * PIXELS + 2 * surface * DENSE_BRICK + 2 * max(updated - surface, 0) * FREE_BRICK,
             "arithmetic": 20 * voxels, "look-ups": voxels},
            f"The image is read once; {surface:,.0f} bricks with surface are read and written whole, {updated - surface:,.0f} "
            "more as free ones. Each of their voxels is projected (20 operations) and looks up one range.")


def surface_cast(frame):
    return ({"memory": 16 * PIXELS + frame("surface_bricks") * DENSE_BRICK, "arithmetic": 100 * PIXELS,
             "look-ups": 8 * PIXELS},
            "Every brick with surface is read once, depth and normal are written; each ray meets only the cell of its hit: "
            "8 corners, 100 operations.")


def alignment(frame):
    coarse = max(frame("iterations") - 3, 0) / 16
    pairs = PIXELS * (1 + 1 / 4 + 1 / 16 + coarse)
    return ({"cache": PIXELS * (4 + 16 + 16) + 32 * pairs, "arithmetic": 110 * pairs + 60 * PIXELS, "look-ups": 4 * pairs},
            f"Of {frame('iterations'):.0f} iterations, one per level and the others at the coarsest; a pair takes 110 "
            "operations and 4 look-ups, a point and its normal 60. All data stays in the caches.")


def evaluation(counter):
    looks = counter("rays") * counter("looks_per_ray")
    return ({"look-ups": looks, "arithmetic": 6 * looks, "cache": counter("lattices") * counter("grid_bytes")},
            f"{counter('rays') / 1e6:.1f} million distinct rays meet the region; each walked by itself would look at "
            f"{counter('looks_per_ray'):.0f} bricks and voxels, 6 operations each. That bounds ray by ray, not what is done: "
            f"tiles leave {counter('rays_open') / 1e6:.1f} million rays to be walked.")


def forgetting():
    bricks = 4 / 3 * 3.14159 * 0.2**3 / (8 * 0.0058)**3
    return ({"memory": 2 * bricks * DENSE_BRICK},
            f"The {bricks:.0f} bricks of the sphere are read and written, by one thread; less than 1 where they are in a "
            "cache, as when the same sphere is forgotten again and again.")


def snapshot(sectors):
    return {"memory": CACHE_LINE * sectors}, f"One cache line for each of {sectors:.0f} sectors, by one thread."


def entries(results):
    """(what, row, threads, amounts, assumption)."""
    made = []

    def counters(row):
        return lambda name: results.counter(row, name)

    frame = counters("phases:tracked_frame/threads:2")
    if frame("bricks_updated"):
        parts = [fusion(frame), surface_cast(frame), alignment(frame)]
        made += [("fuse one frame", "mapping:integrate/2", 2, *parts[0]),
                 ("surface ray cast", "mapping:surface_raycast/2", 2, *parts[1]),
                 ("align one frame", "mapping:icp/2", 2, *parts[2])]
        names = {name for amounts, _ in parts for name in amounts}
        made.append(("a whole tracked frame", "mapping:tracked_frame/2", 2,
                     {name: sum(amounts.get(name, 0) for amounts, _ in parts) for name in names}, "All three."))
    for views, what in ((0, "960 poses ray by ray, region just forgotten"), (1, "960 poses ray by ray, after a view"),
                        (3, "960 poses ray by ray, after three views")):
        counter = counters(f"phases:evaluation/views:{views}")
        if counter("rays"):
            made.append((what, f"view_evaluation:all_savings/views:{views}/threads:2", 2, *evaluation(counter)))
    made.append(("forget a sphere of 0.2 m", "mapping:forget", 1, *forgetting()))
    sectors = results.counter("mapping:snapshot", "sectors")
    if sectors:
        made.append(("snapshot", "mapping:snapshot", 1, *snapshot(sectors)))
    return [entry for entry in made if results.median_ms(entry[1])]


def section(results):
    both = {threads: rates(results, threads) for threads in (1, 2)}
    if not all(rate for threads in both.values() for rate in threads.values()):
        return []
    lines = ["## Physical bounds", "",
             "What this machine does at most (`bench/machine.cpp`): reading an array of 256 MiB, reading one of 256 KiB again",
             "and again, independent multiplications and additions of floats without contraction, and look-ups all over a",
             "table of 256 KiB.", "",
             "| threads | memory, GB/s | cache, GB/s | arithmetic, 10⁹/s | look-ups, 10⁹/s |", "|---|---|---|---|---|"]
    for threads, rate in both.items():
        lines.append(f"| {threads} | " + " | ".join(f"{rate[name] / 1e9:.1f}" for name in RESOURCES) + " |")
    lines += ["", "The bound of a row is the longest of the times that its least work takes at these rates.", "",
              "| work | least work | bound, ms | ours, ms | ours / bound |", "|---|---|---|---|---|"]
    notes = []
    for what, row, threads, amounts, assumption in entries(results):
        amounts = dict(sorted(amounts.items()))
        times = {name: 1e3 * amount / both[threads][name] for name, amount in amounts.items()}
        longest = max(times, key=times.get)
        work = ", ".join(f"{figure(amount / 1e6)} {UNITS[name]}" + (" of cache" if name == "cache" else "")
                         for name, amount in amounts.items())
        ours = results.median_ms(row)
        lines.append(f"| {what} | {work} | {figure(times[longest])} ({longest}) | {figure(ours)} | "
                     f"{ours / times[longest]:.1f} |")
        notes.append(f"- {what[0].upper() + what[1:]}: {assumption}")
    return lines + ["", "Assumed:", "", *notes, ""]
