# SPDX-License-Identifier: Apache-2.0
# Made by scripts/python_stubs.py.
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Sequence, Set, Tuple, Union

import numpy
import numpy.typing

from . import ActionStream, Annotation, Arm, Box, Cylinder, Explorer, Frame, FrameIterator, Frames, PinholeCamera, PlanningContext, Sphere, Strategy, SurfelMap, Tracker, TsdfMap, ViewPlanner

class SimulatedCamera:
    """A depth camera in a scene whose surface is known."""
    def __init__(self, scene: str, *, width: int = ..., noise: bool = ..., seed: int = ..., threads: int = ...) -> None:
        ...
    @property
    def intrinsics(self) -> PinholeCamera:
        ...
    @property
    def workspace(self) -> Box:
        """Box that is to be explored."""
    @property
    def scan(self) -> numpy.typing.NDArray[numpy.float64]:
        """Poses of the scene's initial scan, N x 4 x 4."""
    def capture(self, T_world_camera: numpy.typing.NDArray[Any]) -> numpy.typing.NDArray[numpy.float32]:
        """Depth, H x W float32, metres along z. The n-th frame of a seed is always the same."""
    def measure(self, map: TsdfMap) -> dict:
        """What a map is worth beside the scene's surface: coverage, accuracy_m, chamfer_m, f_score, unknown_left."""

def compare(strategies: Sequence[Any], scenes: List[str], seeds: List[int], *, max_views: int = ..., voxel_size_m: float = ..., width: int = ..., gain_width: int = ..., noise: bool = ..., threads: int = ..., progress: Any = ...) -> dict:
    """Runs each strategy (a name or a Strategy) in each scene with each seed. Returns a dict: `runs`, as those of run() with scene, strategy, seed and seconds; `summary`, a row per scene and strategy with the mean of each figure and its confidence interval (low, high), over all scenes where `scene` is None; `gaps`, the same for differences from the first strategy in the same scene and seed. Figures: docs/reference/metrics.md."""

def run(scene: str, strategy: Any = ..., *, gain: Any = ..., min_gain: Optional[float] = ..., max_views: int = ..., voxel_size_m: float = ..., width: int = ..., gain_width: int = ..., noise: bool = ..., seed: int = ..., threads: int = ..., progress: Any = ...) -> dict:
    """Explores a scene (a built-in name, clutter:SEED or a YAML file) with a flying camera. `strategy`: a name, or a Strategy. `gain(context, poses)` returns one number for each pose (N x 4 x 4) in place of the strategy's own gain; the run ends where no view gains more than `min_gain`, which is then 0 by default. Returns a dict: scan, views, final (measures of the map), stopped_because."""

def scenes() -> List[str]:
    """Names of the built-in scenes."""

def strategies() -> List[str]:
    """Names of the strategies; `oracle` knows the truth, and runs in trials alone."""
