# SPDX-License-Identifier: Apache-2.0
# Made by scripts/python_stubs.py.
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Sequence, Set, Tuple, Union

import numpy
import numpy.typing

from . import trial as trial

class ActionStream:
    """Finds actions while the hand is still moving, as soon as it moves away from one."""
    def __init__(self) -> None:
        ...
    def put(self, time_s: float, position_m: Any) -> list:
        """Takes a sample, seconds and (x, y, z) metres in the world frame. Returns the actions, dicts as of find_actions, that are certain with it: none as a rule."""

class Annotation:
    """Labels of a cloud's points, which spread from clicks along surfaces (thesis 4.2)."""
    def __init__(self, points: Any, *, normals: Any = ..., colors: Any = ..., neighbours: int = ..., threads: int = ..., progress: Any = ...) -> None:
        """`points`: N x 3 metres; `normals`: N x 3, else estimated; `colors`: N x 3, uint8 or floats in [0, 1]. Labels are whole numbers from 1; 0: none."""
    def click(self, points: Any, label: int) -> int:
        """Makes a point, by its index, or several, control points of a label. Returns the number of points with another label than before, as do the other actions."""
    def remove(self, points: Any) -> int:
        """Makes points control points no more."""
    def paint(self, points: Any, label: int) -> int:
        """Gives these points, by their indices, a label whatever spreads to them; 0: they follow clicks again."""
    def select(self, camera: PinholeCamera, T_world_camera: numpy.typing.NDArray[Any], *, rectangle: Any = ..., polygon: Any = ..., stroke: Any = ..., radius_px: float = ..., below_m: float = ..., point_size_px: int = ...) -> numpy.typing.NDArray[numpy.uint32]:
        """Finds the points that a shape contains in the picture of a camera (thesis 4.2.2). `rectangle`: two opposite corners; `polygon`: corners of a lasso; `stroke`: a line, `radius_px` wide to either side; each in pixels (u, v). `below_m`: metres behind what is seen that are still taken, 0: the surface that is seen, inf: however deep. `point_size_px`: edge of a drawn point. Returns indices, uint32, ascending, for click and paint."""
    def undo(self) -> int:
        """Takes back the latest action. -1: there is none."""
    def redo(self) -> int:
        """Brings back what was undone last. -1: there is nothing."""
    def labels(self) -> numpy.typing.NDArray[numpy.uint32]:
        """N uint32; 0: none."""
    @property
    def control_points(self) -> dict:
        """dict from a point's index to its label."""
    @property
    def counts(self) -> Dict[int, int]:
        """dict from a label to the number of its points."""
    def __len__(self) -> int:
        ...

class Arm:
    """An arm that plans its way without touching what is known, or not known, to be there; for Explorer's `robot`. Its own body is taken out of the camera's frames."""
    def __init__(self, robot: str = ..., *, joints: Any = ..., fixtures: Any = ..., start: Any = ..., base: str = ..., tip: str = ..., camera: str = ..., T_flange_camera: Optional[numpy.typing.NDArray[Any]] = ..., T_world_base: Optional[numpy.typing.NDArray[Any]] = ...) -> None:
        """`robot`: a URDF file or a built-in name. `joints`: an object with position() -> q and execute(t_s, q, dq, report), which follows q (N x joints, radians or metres) at the times t_s (N, seconds), calls report(t, q) on its way, and stops where that returns False; None: simulated. `fixtures`: solid boxes, world frame. `start`: q in the beginning. `base`, `tip`, `camera`: links, where the URDF does not say."""
    @property
    def joint_names(self) -> List[str]:
        ...
    @property
    def notes(self) -> List[str]:
        """What was assumed when the URDF was read."""
    def camera_pose(self, q: Any) -> numpy.typing.NDArray[numpy.float64]:
        """T_world_camera, 4 x 4, with the joints at q."""
    @property
    def middle(self) -> numpy.typing.NDArray[numpy.float64]:
        """Each joint in the middle of its range."""

class Box:
    """Axis-aligned box in the world frame, metres; contains p where min <= p < max."""
    def __init__(self, min: Any, max: Any) -> None:
        ...
    @property
    def min(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def max(self) -> numpy.typing.NDArray[numpy.float64]:
        ...

class Cylinder:
    """Solid cylinder around the segment base to top, metres."""
    def __init__(self, base: Any, top: Any, radius_m: float) -> None:
        ...

class Explorer:
    """The loop: chooses a view, moves the camera there, looks, fuses, and begins again."""
    def __init__(self, map: TsdfMap, camera: Any, *, robot: Any = ..., strategy: Any = ..., regions: Any = ..., recorder: Any = ..., stopping: Any = ..., approve: Any = ..., gain_width: int = ..., min_gain: Optional[float] = ..., radii_m: Optional[List[float]] = ..., oscillation_frames: int = ..., good_enough: float = ...) -> None:
        """`camera`: an object with `intrinsics` and capture(T_world_camera) -> depth, (depth, color) or (depth, color, T_world_camera). `robot`: move_to(T_world_camera) -> pose, True, False or None, and where it is there reachable(N x 4 x 4) -> N bools; None: the camera flies; or an Arm. `recorder`: scanned(scan, map), viewed(view, map, depth_images), ended(run). `stopping(run)`: true ends the run. `approve(T_world_camera, gain)`: True, False or 'stop'. `oscillation_frames`: frames at each view, tilted by up to 5 degrees; 1: one."""
    def scan(self, T_world_camera: Any, progress: Any = ...) -> dict:
        """Looks from each pose (N x 4 x 4) that can be reached, and fuses. Begins a new run."""
    def explore(self, max_views: int = ..., progress: Any = ...) -> dict:
        """Goes on until nothing is worth another view, or `max_views` were taken in all. Returns the run's record."""
    @property
    def q(self) -> Any:
        """How the arm's joints stand; None for robots that are no Arm."""
    @property
    def run(self) -> dict:
        """The record so far: scan, views, final, stopped_because."""

class Frame:
    """A recorded frame; depth and colour share the camera."""
    @property
    def depth(self) -> Any:
        """H x W float32, metres along z; 0 or NaN: no return; d < 0: seen free up to |d|."""
    @property
    def color(self) -> Any:
        """H x W x 3 uint8, or None."""
    @property
    def T_world_camera(self) -> Any:
        """4 x 4 float64, or None."""
    @property
    def time_s(self) -> Optional[float]:
        """Seconds, or None."""
    @property
    def name(self) -> str:
        """What a person would call it."""
    @property
    def index(self) -> int:
        """Position in the recording, skipped frames counted."""

class FrameIterator:
    """Goes through frames."""
    def __iter__(self) -> Any:
        ...
    def __next__(self) -> Frame:
        ...

class Frames:
    """Recorded RGB-D frames, each read when it is asked for."""
    def __len__(self) -> int:
        ...
    def __iter__(self) -> FrameIterator:
        ...
    def __getitem__(self, index: int) -> Frame:
        ...
    @property
    def camera(self) -> PinholeCamera:
        """PinholeCamera of all frames."""
    @property
    def has_poses(self) -> bool:
        ...
    @property
    def has_color(self) -> bool:
        ...
    @property
    def damage(self) -> str:
        """What is wrong with a bag, for people; empty where nothing is."""

class PinholeCamera:
    """An undistorted camera: x right, y down, z forward; pixel (u, v) has its centre at integers."""
    def __init__(self, width: int, height: int, *, fx: float, fy: float, cx: Optional[float] = ..., cy: Optional[float] = ..., min_range_m: float = ..., max_range_m: float = ...) -> None:
        """Focal lengths and centre in pixels; the centre defaults to that of the image. Returns outside the range, metres along z, are not trusted."""
    @property
    def width(self) -> int:
        ...
    @property
    def height(self) -> int:
        ...
    @property
    def fx(self) -> float:
        ...
    @property
    def fy(self) -> float:
        ...
    @property
    def cx(self) -> float:
        ...
    @property
    def cy(self) -> float:
        ...
    @property
    def min_range_m(self) -> float:
        ...
    @property
    def max_range_m(self) -> float:
        ...
    def scaled_to_width(self, width: int) -> PinholeCamera:
        """The camera with `width` pixels across; field of view and range stay."""

class PlanningContext:
    """What attention, views and gains may look at."""
    @property
    def map(self) -> TsdfMap:
        """The map so far; a copy that shares memory."""
    @property
    def region(self) -> Any:
        """Box, Sphere or Cylinder that is looked at; None while attention looks for one."""
    @property
    def sensor(self) -> PinholeCamera:
        """The virtual camera that views are chosen with."""
    @property
    def views_taken(self) -> int:
        """Views of the region so far."""

class Sphere:
    """Ball in the world frame, metres."""
    def __init__(self, center: Any, radius_m: float) -> None:
        ...
    @property
    def center(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def radius_m(self) -> float:
        ...

class Strategy:
    """A strategy by its name, with parts of one's own in place of its attention, its views or its gain. Each is a function, or an object with the method named here."""
    def __init__(self, base: str = ..., *, attention: Any = ..., views: Any = ..., gain: Any = ..., min_gain: Optional[float] = ..., name: Optional[str] = ..., gain_unit: str = ...) -> None:
        """`attention.regions(context)`: regions, or (region, saliency). `views.views(context)`: T_world_camera, N x 4 x 4. `gain.evaluate(context, T_world_camera)`: N finite numbers, larger is better. `min_gain`: views that gain less are not worth going to; 0 with a gain of one's own, else the base's."""
    @property
    def base(self) -> str:
        ...
    @property
    def name(self) -> str:
        ...

class SurfelMap:
    """Small coloured discs on surfaces, from frames with poses (thesis 4.1.1). World frame, metres."""
    def __init__(self, *, mode_filter: bool = ..., choice: str = ..., max_modes: int = ..., image_sigma: float = ..., exposure_compensation: bool = ..., threads: int = ...) -> None:
        """`mode_filter`: of each surfel's colours one that was seen, not a blend; it needs frames with colour. `choice`: sharpened, densest, or heaviest (thesis, eq. 4.11, with depths guided by colour). `exposure_compensation`: colours of each frame are brought to the exposure of the first; `threads`: 0 for all cores."""
    def integrate(self, camera: PinholeCamera, depth: numpy.typing.NDArray[Any], T_world_camera: numpy.typing.NDArray[Any], color: Optional[numpy.typing.NDArray[Any]] = ...) -> dict:
        """Fuses a frame; arrays as of TsdfMap.integrate. Returns a dict: points (pixels that count), associated, created, contradicted, gain (of the exposure, or None)."""
    def __len__(self) -> int:
        ...
    def points(self, *, min_confidence: float = ..., averages: bool = ...) -> dict:
        """Surfels of at least that confidence, as a dict: points N x 3 and normals N x 3 float32; colors N x 3 uint8, or None; radii N float32, metres; confidences N float32. `averages`: without the mode filter."""
    def save(self, path: str, *, min_confidence: float = ..., averages: bool = ...) -> None:
        """Writes these surfels: PLY for a name that ends in .ply, else PCD."""

class Tracker:
    """Tracks a camera against a TsdfMap (thesis 2.2.1), and fuses its frames into it. Methods return a dict: accepted, T_world_camera (4 x 4), why (where the track is lost), fused; and of ICP rmse_m (of point-to-plane distances, metres), inlier_share, agreement, iterations (0 where none ran); confidence (0 to 1, or None) and relocalised."""
    def __init__(self, map: Any, camera: PinholeCamera, mode: str = ...) -> None:
        """`mode`: icp (from the last pose; `T_hint` is that of the first frame, else the identity), rgbd (as icp, with the colours of fused frames and from the last motion), hint (ICP from `T_hint`) or forced (`T_hint` as it is)."""
    def track(self, depth: numpy.typing.NDArray[Any], T_hint: Optional[numpy.typing.NDArray[Any]] = ..., color: Optional[numpy.typing.NDArray[Any]] = ...) -> dict:
        """Finds where a depth image, H x W as of TsdfMap.integrate, was taken; map and last pose stay."""
    def fuse(self, depth: numpy.typing.NDArray[Any], T_hint: Optional[numpy.typing.NDArray[Any]] = ..., color: Optional[numpy.typing.NDArray[Any]] = ...) -> dict:
        """As track, and fuses the frame where the track was found. `color`: H x W x 3 uint8."""
    @property
    def T_world_camera(self) -> Any:
        """Pose of the last fused frame, 4 x 4, or None. Set it where the camera was moved meanwhile."""
    @T_world_camera.setter
    def T_world_camera(self, value: Any) -> None: ...

class TsdfMap:
    """Truncated signed distance map that never confuses unknown with empty. World frame, metres."""
    def __init__(self, *, voxel_size_m: float = ..., workspace: Any = ..., truncation_vox: float = ..., free_weight: int = ..., clearing_percent: int = ..., color: bool = ..., threads: int = ...) -> None:
        """`workspace`: a Box, or two corners; voxels outside of it count as neither unknown nor in the way. `clearing_percent`: how much it counts against a surface when a ray passes it by; less than 100 where poses are not exact (`saccade fuse` takes 50). `threads`: 0 for all cores."""
    @staticmethod
    def load(path: str, threads: int = ...) -> TsdfMap:
        """Reads a .sacmap file."""
    def save(self, path: str) -> None:
        """Writes a .sacmap file."""
    def integrate(self, camera: PinholeCamera, depth: numpy.typing.NDArray[Any], T_world_camera: numpy.typing.NDArray[Any], color: Optional[numpy.typing.NDArray[Any]] = ...) -> dict:
        """Fuses a depth image: H x W, float32 metres or uint16 millimetres along z; 0 or NaN: no return; d < 0: seen free up to |d|. `T_world_camera`: 4 x 4 or 3 x 4. `color`: H x W x 3 uint8. Returns counts and ms."""
    def forget(self, region: Any) -> None:
        """Sets the voxels of a region back to unknown."""
    def free(self, region: Any) -> None:
        """Sets the voxels of a region empty."""
    def count_unknown(self, region: Any) -> int:
        """Unknown voxels of a region, within the workspace."""
    def ternary(self, box: Any = ...) -> numpy.typing.NDArray[numpy.int8]:
        """int8 (z, y, x): -1 empty, 0 unknown, 1 occupied; of a box, else the workspace, else all that is known."""
    def tsdf(self, box: Any = ...) -> numpy.typing.NDArray[numpy.float32]:
        """float32 (z, y, x): signed distance over the truncation, in [-1, 1]."""
    def weights(self, box: Any = ...) -> numpy.typing.NDArray[numpy.uint16]:
        """uint16 (z, y, x): observations of each voxel; 0: unknown."""
    def origin(self, box: Any = ...) -> numpy.typing.NDArray[numpy.float64]:
        """Centre (x, y, z) of the first voxel of such an array."""
    def mesh(self, min_weight: int = ...) -> dict:
        """dict: vertices N x 3 float32, normals N x 3 float32, colors N x 3 uint8 (or 0 x 3), triangles M x 3 uint32."""
    @property
    def voxel_size_m(self) -> float:
        ...
    def close(self) -> None:
        """Gives the memory back; the map cannot be used after it."""

class ViewPlanner:
    """Says where to look next; moves and fuses nothing."""
    def __init__(self, camera: PinholeCamera, strategy: Any = ..., *, regions: Any = ..., gain_width: int = ..., min_gain: Optional[float] = ..., radii_m: Optional[List[float]] = ...) -> None:
        """`strategy`: a name of trial.strategies(), or a Strategy. `regions`: to look at, one after the other; the map's workspace by default. `gain_width`: pixels across of the virtual camera. `radii_m`: distances of views, metres."""
    def next_views(self, map: TsdfMap, count: int = ..., taken: Any = ...) -> list:
        """The best views of the map as it is, at most `count`, as dicts of T_world_camera (4 x 4) and gain; empty where no view is worth taking. `taken`: poses that are not to be named again."""

def annotation_score(labels: Any, truth: Any) -> dict:
    """Compares labels with true ones, N whole numbers each, 0 in truth: the point does not count. Returns a dict: points that count, wrong ones, mean_iou over the labels."""

def depth_points(camera: PinholeCamera, depth: numpy.typing.NDArray[Any], T_world_camera: Optional[numpy.typing.NDArray[Any]] = ...) -> numpy.typing.NDArray[numpy.float32]:
    """Returns H x W x 3 float32: the point of each pixel, metres, in the world frame, or in the camera's without a pose; NaN where there is no return within the camera's range."""

def filter_kinect_v2(camera: PinholeCamera, depth: numpy.typing.NDArray[Any], *, method: str = ..., baseline_m: float = ..., emitter_side: str = ..., veil_angle_deg: float = ..., shadow_points: bool = ..., veil_points: bool = ..., threads: int = ...) -> tuple:
    """Removes the wrong points of a Kinect v2's depth image, H x W as of TsdfMap.integrate (thesis 3.1.3). `method`: surface (keeps what lies on a surface) or thesis (Algorithm 5, eq. 3.19). `baseline_m`: from the camera to the emitter, which is on the `emitter_side` left or right of the image. Returns the depth, H x W float32 with 0 where a point was removed, and what each pixel is, H x W uint8: 0 no return, 1 kept, 2 shadow point, 3 veil point."""

def find_actions(times_s: Any, positions_m: Any, *, method: str = ..., as_printed: bool = ...) -> list:
    """Finds where a hand did something. `times_s`: N seconds that never decrease; `positions_m`: N x 3 metres, world frame. `method`: ours (dips of the smoothed speed), gmm-as or zvc (thesis 2.2.4). `as_printed`: formula and thresholds as the thesis prints them. Returns a list of dicts by time: time_s, position_m, saliency (in the unit of the method; larger is more certain), why."""

def guided_filter(depth: numpy.typing.NDArray[Any], guide_depth: numpy.typing.NDArray[Any], guide_color: numpy.typing.NDArray[Any], *, radius_px: int = ..., color_sigma: float = ..., depth_sigma_m: float = ..., threads: int = ...) -> numpy.typing.NDArray[numpy.float32]:
    """Smooths a depth image where its guide, depth H x W metres and colour H x W x 3 uint8, is smooth, and keeps the guide's edges (thesis, Algorithm 7). Returns H x W float32; pixels without depth or guide stay."""

def look_at(position: Any, target: Any, up: Any = ..., roll_rad: float = ...) -> numpy.typing.NDArray[numpy.float64]:
    """T_world_camera, 4 x 4, of a camera at `position` whose optical axis points at `target`."""

def open_frames(path: str, layout: str = ..., *, camera: Optional[PinholeCamera] = ..., poses: Optional[str] = ..., depth_scale: Optional[float] = ..., mask: Optional[str] = ..., min_range_m: Optional[float] = ..., max_range_m: Optional[float] = ..., fill_gaps_px: Optional[int] = ..., color: bool = ..., require_poses: bool = ..., first: int = ..., every: int = ..., count: Optional[int] = ..., depth_topic: str = ..., info_topic: str = ..., color_topic: str = ..., world_frame: str = ...) -> Frames:
    """Opens a folder of RGB-D frames, a bag of ROS (.bag) or an MCAP file (.mcap), as saccade fuse does. `layout`: auto, seven-scenes, tum, princeton, open3d, scannet, bundlefusion, rtabmap, replica, bop, icl-nuim or sun3d. `camera`: PinholeCamera in place of the folder's. `poses`: file of T_world_camera in place of the folder's. `depth_scale`: depth samples per metre. `mask`: PNG (0: ignored) or JSON polygons. `fill_gaps_px`: close gaps up to this wide; None: 2 where the first frame has them all over. `require_poses`: where there are poses, a frame without a good one is an error. Topics and `world_frame` are of bags. Returns Frames."""

def read_cloud(path: str) -> dict:
    """Reads a point cloud: PCD, PLY, LAS, an array of NumPy (.npy), text (.xyz, .txt, .csv, .pts, .asc) or a scan of KITTI (.bin). Returns a dict: points N x 3 float32, metres; offset 3 float64, to add to points, not zero for a cloud far from its origin; normals N x 3 float32; colors N x 3 uint8; radii N float32, metres; labels N uint32, 0: none. None for what the file lacks."""

def read_hand(path: str, *, hand: str = ..., world_frame: str = ...) -> tuple:
    """Reads the motion of a hand: .traj, .csv, .tum or .txt, or a bag (.bag, .mcap) with a topic or TF frame `hand`. Returns times_s (N seconds) and positions_m (N x 3 metres); bad samples are left out."""

def score_actions(actions: List[dict], labels_m: Any, *, match_radius_m: float = ...) -> dict:
    """Compares actions with where the hand acted in truth, `labels_m`: M x 3 metres. Returns a dict: labels, true_positives, false_positives, precision, recall (None without a denominator), location_errors_m."""

def segment(points: Any, method: str = ..., *, normals: Any = ..., colors: Any = ..., radii: Any = ..., voxel_size_m: Optional[float] = ..., seed_spacing_m: Optional[float] = ..., threshold: Optional[float] = ..., spatial_weight: Optional[float] = ..., normal_weight: Optional[float] = ..., color_weight: Optional[float] = ..., rounds: Optional[int] = ..., concavity_deg: float = ..., min_supervoxels: int = ..., single_camera: bool = ..., viewpoint: Any = ..., threads: int = ...) -> numpy.typing.NDArray[numpy.uint32]:
    """Divides points, N x 3 metres, into segments. `method`: lccp (supervoxels joined where surfaces bend outwards), sv-lccp (these kept apart by colours) or flood-fill (surfels that touch and look alike; thesis 4.1.2). `normals`: N x 3; `colors`: N x 3, uint8 or floats in [0, 1]; `radii`: N metres; what is None is estimated, normals towards `viewpoint`, or left out. `single_camera`: points are in a camera's frame, and voxels grow with depth. None stands for the method's own value. Returns N uint32: 1, 2, ... by segment, 0 where a point is not finite."""

def segment_curve(points: Any, truth: Any, thresholds: Any, method: str = ..., *, normals: Any = ..., colors: Any = ..., radii: Any = ..., tolerance_m: float = ..., split: bool = ..., threads: int = ..., progress: Any = ...) -> dict:
    """Scores segments at many thresholds, of sv-lccp or flood-fill, against true labels (thesis Figs. 4.10 and 4.11, Table 4.3). Arguments as of segment and segment_scores. Returns a dict: points, one a threshold, each with threshold, segments, boundary_precision, boundary_recall, boundary_f, consistency_error; area below precision over recall; best_f and least_consistency_error, the points that have these."""

def segment_map(map: TsdfMap, *, voxel_size_m: float = ...) -> dict:
    """Divides the surface of a TsdfMap into segments. Returns a dict: points N x 3 float32, metres, world frame; normals N x 3 float32; labels N uint32 from 1."""

def segment_saliency(points: Any, labels: Any, heuristic: str = ..., *, threads: int = ...) -> numpy.typing.NDArray[numpy.float64]:
    """How much segments draw attention, float64 in [0, 1] for each label from 1. `points`: N x 3 metres; `labels`: N as of segment. `heuristic`: objectness (thesis eq. 3.12), roundness, isolation, rough-first."""

def segment_scores(labels: Any, truth: Any, *, points: Any = ..., radii: Any = ..., objects_from: int = ..., tolerance_m: float = ..., split: bool = ..., threads: int = ...) -> dict:
    """Compares segments with true ones, N whole numbers each, 0: none. Returns a dict: objects, weighted_overlap, over_segmentation, under_segmentation; weighted_overlap_objects (of true labels from `objects_from`); consistency_error (bidirectional, thesis 4.1.2); with `points`, N x 3 metres, boundary_precision, boundary_recall, boundary_f within `tolerance_m`, and the truth is split where its surfels do not touch, unless `split` is False."""

def simulate_annotation(points: Any, truth: Any, *, normals: Any = ..., colors: Any = ..., clicks: int = ..., neighbours: int = ..., threads: int = ..., progress: Any = ...) -> list:
    """Clicks as someone who knows the true labels, N whole numbers, 0: does not matter: each at the centre of the largest region that is wrong. Returns a list of dicts, one a click: point, label, and with it wrong (points) and mean_iou."""

def view_gains(map: TsdfMap, region: Any, T_world_camera: Any, camera: PinholeCamera, *, tilt_deg: float = ..., count: str = ..., progress: Any = ...) -> numpy.typing.NDArray[numpy.uint64]:
    """uint64, one for each pose (N x 4 x 4): rays of the camera whose first voxel that is not empty is unknown and inside the region; with count='voxels' those voxels, each once. `progress(stage, done, total)`."""

def view_sphere(center: Any, *, radii_m: List[float] = ..., longitude_step_deg: float = ..., latitude_step_deg: float = ..., roll_step_deg: float = ..., latitude_min_deg: float = ..., latitude_max_deg: float = ...) -> numpy.typing.NDArray[numpy.float64]:
    """T_world_camera, N x 4 x 4, of views around `center` that look at it; 960 by default (thesis 2.2.3)."""

def write_cloud(path: str, points: Any, *, normals: Any = ..., colors: Any = ..., radii: Any = ..., labels: Any = ..., offset: Any = ...) -> None:
    """Writes points N x 3, metres: PLY for a name that ends in .ply, text for .xyz, .txt, .csv, .pts or .asc, else binary PCD. `normals`: N x 3; `colors`: N x 3, uint8 or floats in [0, 1]; `radii`: N metres; `labels`: N whole numbers, 0: none; `offset`: 3 numbers that are added to the points, as read_cloud gives them."""
