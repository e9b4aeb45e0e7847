// SPDX-License-Identifier: Apache-2.0
// Interface of the 3-D view for the annotation tool and the viewer. createViewer() in viewer.ts makes one.

/** Column-major 4×4, as WebGL has it. */
export type Mat4 = Float64Array | number[];
export type Rgb = readonly [number, number, number]; // 0 to 255

/** A piece of the cloud as `points` answers it. Arrays are kept, not copied. */
export interface PointChunk {
  positions: Float32Array; // x, y, z
  points: Uint32Array; // indices in the cloud's file
  colors: Uint8Array; // r, g, b, 255
  labels: Uint32Array;
  values?: Float32Array; // the field that is shown, of tiles
}

/** The answer to `octree`. */
export interface Octree {
  cube: readonly [number, number, number, number]; // least corner, edge
  nodes: ArrayBuffer; // per node u32 parent, level, x, y, z, count, f32 spacing
}

export interface CloudInfo {
  points: number; // in the file: the length of a map from them to vertices
  shown: number; // vertices there will be
  tiles?: number; // they come in tiles: how many there are
  bounds: readonly number[]; // x0, y0, z0, x1, y1, z1
  up: readonly number[];
  spacing_m: number;
}

/** What is under the cursor: a point of the cloud, or the control point whose sphere is there. */
export interface Pick {
  point: number;
  control: boolean;
  position: readonly [number, number, number];
}

/** What is drawn of a control point. */
export interface ControlPlace {
  point: number;
  label: number;
  position: readonly [number, number, number];
}

/** The picture as the program's selection takes it (docs/reference/protocol.md: "view" of an action). */
export interface SelectionPicture {
  size: [number, number];
  clip_world: number[]; // 16, row by row
  point_size_px: number;
}

/**
 * Colours, r, g, b, 255, of `count` vertices from `first` on, whose places are these (x, y, z). `values`: what came
 * with a tile. null: their own.
 */
export type Painter = (positions: Float32Array, first: number, count: number, values?: Float32Array) => Uint8Array | null;

/** Box around a label: size along its axes, metres; colour 0 to 255. */
export interface LabelBox {
  center: readonly number[];
  size: readonly number[];
  axes: readonly (readonly number[])[];
  color: Rgb;
}

export interface CloudLayer {
  begin(cloud: CloudInfo): void;
  append(chunk: PointChunk): void;
  /** After begin(): the points come in tiles. Calls `wake` when others may be wanted. */
  beginTiles(octree: Octree, vertices: number, wake: () => void): void;
  /** Tiles to ask for now, with at most `mostPoints` points, and those to give up for them; null: none. */
  nextTiles(mostPoints: number): { nodes: number[]; drop: number[] } | null;
  /** The tiles' points, one tile after the other. */
  addTiles(nodes: readonly number[], chunk: PointChunk): void;
  heldTiles(): { node: number; count: number }[];
  /** Gives up all tiles, so that they come anew. */
  dropTiles(): void;
  /** As setMargins, of these tiles. */
  setTileMargins(nodes: readonly number[], margins: Uint8Array): void;
  /** Colours in place of the points' own, now and for points that come; null: their own. */
  setPainter(painter: Painter | null): void;
  /** The labels of these points are now this one. */
  setLabel(label: number, points: Uint32Array): void;
  setLabelColor(label: number, color: Rgb): void;
  /** Hidden: its points are not drawn, picked or selected. Label 0 is the points without one. */
  setLabelVisible(label: number, visible: boolean): void;
  /** Boxes that are drawn over the points; empty: none. */
  setBoxes(boxes: readonly LabelBox[]): void;
  /** Points outside of the box are neither drawn nor picked; null: all are. Metres, in the cloud's frame. */
  setClip(box: { low: readonly number[]; high: readonly number[] } | null): void;
  /** Calls `run` whenever hover() begins to find points: some time after all points are here. */
  onHoverReady(run: () => void): void;
  labelOf(point: number): number;
  positionOf(point: number): readonly [number, number, number] | undefined;
  /** Label 0: it is none any more. Its point may be none of the cloud's that are here. */
  setControlPoint(control: ControlPlace): void;
  clearControlPoints(): void;
  /** Takes the margins of the shown points in the order of their chunks: 0 in doubt … 255 sure; null ends the heat map. */
  setMargins(margins: Uint8Array | null): void;
  /** Points that stand out (a tree about to be removed); empty: none. */
  highlight(points: Uint32Array): void;
  /** A place that stands out with a ring (the next best click, a control point jumped to). */
  mark(place: readonly [number, number, number] | null): void;
  /** Thesis §4.2.2: with `cloud` off a point is its label's colour, black without one; with `labels` off its own. */
  show(what: { cloud: boolean; labels: boolean; controls: boolean }): void;
  pointSize: number; // px, edge of the square, 1 to 16
}

export type LayerKind = "triangles" | "points" | "voxels" | "lines" | "views";

/** A layer of the document (docs/reference/protocol.md, Viewer) without its buffer. */
export interface LayerInfo {
  id: string;
  kind: LayerKind;
  count: number;
  visible?: boolean; // true unless it is said
  vertices?: number; // triangles
  colors?: boolean;
  color?: string; // "#rrggbb", where the buffer has none
  size_m?: number; // voxels; points: discs as wide as this, else squares of the view's point size
  diameters?: boolean; // points: a float for each, in m, after the colours; size_m then says how many times as wide
  fov_rad?: readonly [number, number]; // views
  opacity?: number; // 0 to 1; 1 unless it is said
}

/** What is under the cursor: the item (view, voxel, point, triangle) of a layer. */
export interface LayerPick {
  layer: string;
  item: number;
  position: readonly [number, number, number];
}

export interface SceneLayers {
  /** Replaces a layer of the same id. The buffer is as the protocol has it; false if it is too short for that. */
  add(layer: LayerInfo, buffer: ArrayBuffer): boolean;
  remove(id: string): void;
  clear(): void;
  has(id: string): boolean;
  ids(): string[];
  show(id: string, visible: boolean): void;
  /** One view of a layer of kind `views` that stands out; null: none. */
  select(id: string, item: number | null): void;
  /** The nearest view whose pyramid is under these css pixels; layers that are not shown have none. */
  pickView(x: number, y: number): LayerPick | null;
}

/** Edges of a picture that is not shown: a camera at its place in the scene. */
export interface CameraFrame {
  poseRows: readonly (readonly number[])[];
  fov_rad: readonly [number, number];
}

export type Navigation = "orbit" | "fly";
/** Views of one window: three orthographic ones, and the perspective one that is turned. */
export type PaneName = "top" | "front" | "side" | "free";

export interface Camera {
  navigation: Navigation;
  /** Whole scene in view; `from` is a direction towards the viewer. */
  fit(from?: readonly [number, number, number]): void;
  /** Moves, quickly, until this place is in the middle and near. */
  goTo(place: readonly [number, number, number]): void;
  /** World from camera, x right, y down, z forward (the protocol's frame), row-major rows. */
  poseRows(): number[][];
  setPoseRows(rows: readonly (readonly number[])[], fovVertical_rad?: number): void;
}

export interface Stats {
  frames: number;
  lastFrame_ms: number; // until the GPU was done
  vertices: number; // in the picture: the cloud's and large layers'
  pictures: number; // that became complete
  lastPicture_ms: number; // from its beginning until it was
}

export interface Viewer {
  /** Has data-picture, a number that counts up, while its picture is complete and nothing waits to be drawn. */
  readonly element: HTMLElement;
  readonly camera: Camera;
  readonly cloud: CloudLayer;
  readonly layers: SceneLayers;
  /** Sets the bounds that fit() shows and the direction up, for layers without a cloud. cloud.begin() sets its own. */
  setBounds(bounds: readonly number[], up: readonly number[]): void;
  /** A camera drawn as a frame (the view of the step that is looked at); null: none. */
  setFrame(frame: CameraFrame | null): void;
  /** Four views of the scene in one picture, or the free one alone. data-pane of `element` names the one in use. */
  setFour(four: boolean): void;
  /** Whole scene in view, in all views. */
  fit(): void;
  /** Draws soon, once, however often it is asked. Everything above asks by itself. */
  redraw(): void;
  /** Exact, by id buffer; css pixels from the upper left corner of `element`. */
  pick(x: number, y: number): Pick | null;
  /** Quick, by a bounding volume hierarchy that is built in a worker; null while there is none. */
  hover(x: number, y: number): Pick | null;
  /** Picture of the view in use: where the tool was begun, else where the cursor is. */
  picture(): SelectionPicture;
  /** css pixels of `element` to pixels of picture(). */
  toPicture(x: number, y: number): [number, number];
  /** Mouse: the tool has the left button unless it returns false or there is none; the camera has the others. */
  setPointerTool(tool: PointerTool | null): void;
  setTheme(dark: boolean): void;
  /** Surfaces are shaded by depth (eye-dome lighting), so that what has no colours has a shape. */
  setShading(shaded: boolean): void;
  /** For tests and for the frame time in the corner. A picture of a large cloud may take several frames. */
  readonly stats: Stats;
  dispose(): void;
}

export interface PointerTool {
  cursor: string;
  /** Something is begun that a press elsewhere goes on with: the view in use stays so. */
  readonly drawing?: boolean;
  down(x: number, y: number, event: PointerEvent): boolean;
  move(x: number, y: number, event: PointerEvent): void;
  up(x: number, y: number, event: PointerEvent): void;
  cancel(): void;
}
