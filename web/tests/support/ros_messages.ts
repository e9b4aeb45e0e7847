// SPDX-License-Identifier: Apache-2.0
// Messages of a run, decoded by the schema that came with them, and what is expected of each kind.
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { expect } from "@playwright/test";

interface Point {
  x: number;
  y: number;
  z: number;
}
interface Header {
  stamp: { sec: number; nanosec: number };
  frame_id: string;
}
interface Pose {
  position: Point;
  orientation: Point & { w: number };
}
interface PointCloud2 {
  header: Header;
  height: number;
  width: number;
  fields: { name: string; offset: number; datatype: number; count: number }[];
  is_bigendian: boolean;
  point_step: number;
  row_step: number;
  data: Uint8Array;
}
interface OccupancyGrid {
  header: Header;
  info: { resolution: number; width: number; height: number; origin: Pose };
  data: Int8Array;
}
interface MarkerArray {
  markers: { header: Header; ns: string; type: number; points: Point[]; colors: unknown[] }[];
}
interface TFMessage {
  transforms: { header: Header; child_frame_id: string; transform: { translation: Point; rotation: Point & { w: number } } }[];
}
interface Image {
  header: Header;
  height: number;
  width: number;
  encoding: string;
  step: number;
  data: Uint8Array;
}

export const kTypes: Record<string, string> = {
  "/saccade/occupied": "sensor_msgs/msg/PointCloud2",
  "/saccade/frontier": "sensor_msgs/msg/PointCloud2",
  "/saccade/map_2d": "nav_msgs/msg/OccupancyGrid",
  "/saccade/candidates": "visualization_msgs/msg/MarkerArray",
  "/saccade/next_view": "geometry_msgs/msg/PoseStamped",
  "/saccade/plan": "nav_msgs/msg/Path",
  "/tf": "tf2_msgs/msg/TFMessage",
  "/saccade/depth/image_raw": "sensor_msgs/msg/Image",
  "/saccade/depth/camera_info": "sensor_msgs/msg/CameraInfo",
};

/** Workspace of a scene, and the size of its voxels. */
export interface Place {
  low: readonly [number, number, number];
  high: readonly [number, number, number];
  voxel_m: number;
}

export function readerOf(schema: string): (data: ArrayBufferView) => unknown {
  const reader = new MessageReader(parse(schema, { ros2: true }));
  return (data) => reader.readMessage(data);
}

function expectPose(pose: Pose): void {
  for (const value of [pose.position.x, pose.position.y, pose.position.z]) expect(Math.abs(value)).toBeLessThan(3);
  const { x, y, z, w } = pose.orientation;
  expect(Math.hypot(x, y, z, w)).toBeCloseTo(1, 6);
}

function expectCloud(cloud: PointCloud2, names: readonly string[], place: Place): void {
  expect(cloud.header.frame_id).toBe("world");
  expect(cloud.fields.map((field) => field.name)).toEqual(names);
  expect(cloud.fields.every((field) => field.datatype === 7 && field.count === 1)).toBe(true);
  expect(cloud.point_step).toBe(4 * names.length);
  expect(cloud.height).toBe(1);
  expect(cloud.width).toBeGreaterThan(1000);
  expect(cloud.data.byteLength).toBe(cloud.width * cloud.point_step);
  const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
  let outside = 0;
  for (let i = 0; i < cloud.width; ++i) {
    for (const axis of [0, 1, 2] as const) {
      const value = view.getFloat32(i * cloud.point_step + 4 * axis, true);
      if (!(value > place.low[axis] - place.voxel_m && value < place.high[axis] + place.voxel_m)) ++outside; // NaN, too
    }
  }
  expect(outside).toBe(0);
}

function expectGrid(grid: OccupancyGrid, place: Place): void {
  const { resolution, width, height, origin } = grid.info;
  expect(resolution).toBeCloseTo(place.voxel_m, 6);
  expect(width * resolution).toBeCloseTo(place.high[0] - place.low[0], 1);
  expect(height * resolution).toBeCloseTo(place.high[1] - place.low[1], 1);
  expect(origin.position.x).toBeCloseTo(place.low[0], 1);
  expect(grid.data.length).toBe(width * height);
  const values = new Set(grid.data);
  expect([...values].every((value) => value === -1 || value === 0 || value === 100)).toBe(true);
  expect(values.has(100)).toBe(true);
}

function expectMarkers(message: MarkerArray): void {
  expect(message.markers.map((marker) => marker.ns)).toEqual(["candidates", "chosen"]);
  for (const marker of message.markers) {
    expect(marker.header.frame_id).toBe("world");
    expect(marker.type).toBe(5); // lines
    expect(marker.points.length).toBeGreaterThan(0);
    expect(marker.points.length % 2).toBe(0);
    expect(marker.points.every((p) => Number.isFinite(p.x + p.y + p.z))).toBe(true);
  }
  expect(message.markers[0]?.colors.length).toBe(message.markers[0]?.points.length);
  expect(message.markers[1]?.points.length).toBe(16);
}

function expectImage(image: Image): void {
  expect(image.encoding).toBe("32FC1");
  expect(image.step).toBe(4 * image.width);
  expect(image.data.byteLength).toBe(image.step * image.height);
  const view = new DataView(image.data.buffer, image.data.byteOffset, image.data.byteLength);
  let near = 0;
  for (let i = 0; i < image.width * image.height; ++i) {
    const depth_m = view.getFloat32(4 * i, true);
    if (depth_m > 0.1 && depth_m < 5) ++near;
  }
  expect(near).toBeGreaterThan(0.2 * image.width * image.height);
}

/** Fails where a decoded message is not what docs/guides/looking-at-runs.md says of its topic. */
export function expectMessage(topic: string, message: unknown, place: Place): void {
  switch (topic) {
    case "/saccade/occupied":
      return expectCloud(message as PointCloud2, ["x", "y", "z", "rgb"], place);
    case "/saccade/frontier":
      return expectCloud(message as PointCloud2, ["x", "y", "z"], place);
    case "/saccade/map_2d":
      return expectGrid(message as OccupancyGrid, place);
    case "/saccade/candidates":
      return expectMarkers(message as MarkerArray);
    case "/saccade/next_view":
      return expectPose((message as { pose: Pose }).pose);
    case "/saccade/plan":
      for (const { pose } of (message as { poses: { pose: Pose }[] }).poses) expectPose(pose);
      return;
    case "/tf": {
      const { transforms } = message as TFMessage;
      expect(transforms.map(({ header, child_frame_id }) => [header.frame_id, child_frame_id])).toEqual([["world", "saccade_camera"]]);
      for (const { transform } of transforms) expectPose({ position: transform.translation, orientation: transform.rotation });
      return;
    }
    case "/saccade/depth/image_raw":
      return expectImage(message as Image);
    case "/saccade/depth/camera_info": {
      const info = message as { header: Header; width: number; k: ArrayLike<number> };
      expect(info.header.frame_id).toBe("saccade_camera");
      expect(info.k[0]).toBeGreaterThan(0);
      expect(info.k[2]).toBeCloseTo((info.width - 1) / 2, 0);
      return;
    }
    default:
      throw new Error(`${topic} is no topic of a run`);
  }
}
