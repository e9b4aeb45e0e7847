// SPDX-License-Identifier: Apache-2.0
// The viewer: a document of layers and steps, and what a person does with it.
import { type Connection, Disconnected, type Hello } from "../connection";
import { type Side, firstLook, lookFrom } from "../view/standpoint";
import { Shortcuts } from "../ui/shortcuts";
import { ThemeSwitch } from "../ui/theme";
import { toast } from "../ui/toast";
import { createViewer } from "../view/viewer";
import { acrossFrom, steppedBack } from "./across";
import { BufferCache } from "./buffers";
import { CandidateCard } from "./candidate_card";
import { fovOf, type Layer, type SceneDocument } from "./document";
import { addShortcuts } from "./keys";
import { Look } from "./look_of_layers";
import { LookThrough } from "./look_through";
import { ShowPage } from "./page";
import { Player } from "./player";
import { Scene } from "./scene";
import { earlierSteps } from "./trail";

const kPatience_ms = 200; // before a bar says that something is loaded

export function startShow(connection: Connection, hello: Hello, app: Element): void {
  new Show(connection, hello, app);
}

class Show {
  private document: SceneDocument | null = null;
  private fetching: Promise<void> | null = null;
  private stale = false;
  private ownStep = true; // the step's camera is looked through, not a candidate's
  private from: [number, number, number] | undefined; // where one stands to see everything
  private firstPose = "";
  private loadTimer = 0;
  private loaded: [number, number] = [0, 0];

  private readonly player = new Player();
  private readonly look = new Look();
  private readonly shortcuts = new Shortcuts();
  private readonly page: ShowPage;
  private readonly viewer;
  private readonly scene: Scene;
  private readonly lookThrough: LookThrough;
  private readonly card: CandidateCard;

  constructor(
    private readonly connection: Connection,
    hello: Hello,
    app: Element,
  ) {
    this.page = new ShowPage(app, this.player, this.look, {
      layersChanged: () => void this.present(),
      lookThrough: (through) => this.setLooking(through),
      fit: (from) => this.fit(from),
      navigation: (navigation) => void (this.viewer.camera.navigation = navigation),
      shading: (shaded) => this.viewer.setShading(shaded),
      pointSize: (size_px) => void (this.viewer.cloud.pointSize = size_px),
      help: () => this.shortcuts.showHelp(),
    });
    this.page.setTitle(hello.title);
    this.viewer = createViewer(this.page.view, { smooth: true });
    const theme = new ThemeSwitch((dark) => this.viewer.setTheme(dark));
    this.page.addThemeButton(theme.button);
    const buffers = new BufferCache((question) => connection.ask(question), (done, total) => this.progress(done, total));
    this.scene = new Scene(this.viewer, buffers, this.look, (layer, error) => this.failed(layer, error));
    this.lookThrough = new LookThrough(this.viewer.camera, this.page.view);
    this.lookThrough.changed = (active) => this.lookingChanged(active);
    this.card = new CandidateCard(this.viewer, this.scene, {
      lookFrom: (rows, fov_rad, name) => {
        this.ownStep = false;
        this.lookThrough.through(rows, fov_rad, this.withoutArm(name));
      },
      goTo: (item) => this.player.go(this.earlier()[item] ?? 0),
      trailName: (item) => this.document?.steps[this.earlier()[item] ?? 0]?.name ?? "",
    });
    this.page.stage.append(this.lookThrough.element, this.card.tip, this.card.card);
    addShortcuts(this.shortcuts, this.player, this.page, {
      fit: (from) => this.fit(from),
      toggleLooking: () => this.setLooking(!this.lookThrough.active),
      stopLooking: () => this.lookThrough.end(true),
    });

    this.player.changed = () => this.draw();
    this.player.show = () => this.present();
    connection.on("document", () => void this.refresh());
    connection.watch((state) => {
      this.page.setConnection(state);
      if (state === "connected") void this.refresh();
    });
    this.page.setConnection(connection.state);
    void this.refresh();
  }

  /** The program's document, once more. Of several that come while one is under way, the last one counts. */
  private refresh(): Promise<void> {
    this.stale = true;
    this.fetching ??= this.fetchAll().finally(() => (this.fetching = null));
    return this.fetching;
  }

  private async fetchAll(): Promise<void> {
    while (this.stale) {
      this.stale = false;
      try {
        const { head } = await this.connection.ask({ type: "document" });
        await this.take(head["document"] as SceneDocument);
      } catch (error) {
        if (!(error instanceof Disconnected)) toast((error as Error).message, { kind: "error" });
      }
    }
  }

  private take(document: SceneDocument): Promise<void> {
    const first = this.document === null;
    const moved = first || String(this.document?.bounds) !== String(document.bounds);
    this.document = document;
    if (moved) this.viewer.setBounds(document.bounds, document.up);
    if (first) {
      // Without colours and without shading a cloud would show no shape.
      this.page.setShading(document.kind === "cloud" && document.layers.every((layer) => !layer.colors || !layer.visible));
      this.stand();
      this.firstPose = String(this.viewer.camera.poseRows());
    }
    this.page.setDocument(document);
    this.player.resize(document.steps.length, document.live);
    return this.present().then(() => this.stepAside());
  }

  /** Moves the standpoint to where the arm does not hide the scene, unless the user has moved it. */
  private async stepAside(): Promise<void> {
    const { document } = this;
    if (!document || this.from) return;
    const before = String(this.viewer.camera.poseRows());
    const beside = await this.scene.beside(document, this.player.step);
    this.from = beside && acrossFrom(document.bounds, document.up, beside);
    if (this.from && before === this.firstPose && !this.lookThrough.active) this.stand();
  }

  private async present(): Promise<void> {
    const { document } = this;
    if (!document) return;
    const step = this.player.step;
    this.page.stage.ariaBusy = "true";
    const exchanged = await this.scene.present(document, step);
    if (!exchanged) return; // a later one is under way
    this.page.stage.ariaBusy = "false";
    this.card.clear();
    for (const [id, scale] of this.scene.scales()) {
      const layer = document.layers.find((each) => each.id === id);
      if (layer) this.page.layers.setScale(layer, scale);
    }
    for (const { layer, gains } of this.scene.allCandidates()) this.page.layers.setGains(layer.id, gains);
    if (this.lookThrough.active && this.ownStep) this.setLooking(true);
  }

  private draw(): void {
    if (this.document) this.page.draw(this.document);
  }

  private setLooking(through: boolean): void {
    const step = this.document?.steps[this.player.step];
    this.ownStep = true;
    if (through && step?.T_world_camera) this.lookThrough.through(step.T_world_camera, fovOf(step), this.withoutArm(step.name));
    else this.lookThrough.end(true);
  }

  private withoutArm(name: string): string {
    return this.scene.holderShown ? `${name} · the arm is hidden` : name;
  }

  private lookingChanged(active: boolean): void {
    this.page.step.setLooking(active && this.ownStep);
    this.scene.showCameras(!active);
  }

  private fit(from?: Side): void {
    this.lookThrough.end(false);
    if (from) lookFrom(this.viewer.camera, this.document?.up ?? [0, 0, 1], from);
    else this.stand();
  }

  /** Where everything is seen: the scene in the middle, with room for an arm and the bar of steps. */
  private stand(): void {
    const { camera } = this.viewer;
    const { document } = this;
    if (!document) return;
    if (!this.from) return firstLook(camera, document.up, document.towards_viewer);
    camera.fit(this.from);
    camera.setPoseRows(steppedBack(camera.poseRows(), document.bounds));
  }

  private earlier(): number[] {
    return this.document ? earlierSteps(this.document, this.player.step) : [];
  }

  private progress(done: number, total: number): void {
    this.loaded = [done, total];
    if (total === 0) {
      clearTimeout(this.loadTimer);
      this.loadTimer = 0;
      this.page.loading.hide();
    } else if (!this.page.loading.element.hidden) this.showProgress();
    else if (this.loadTimer === 0) this.loadTimer = window.setTimeout(() => this.showProgress(), kPatience_ms);
  }

  private showProgress(): void {
    this.page.loading.show("Loading", this.loaded[0], this.loaded[1], this.viewer.layers.ids().length > 0);
  }

  private failed(layer: Layer, error: Error): void {
    if (error instanceof Disconnected) return; // asked again when the program is back
    toast(`“${layer.name}” cannot be shown: ${error.message}`, { kind: "error" });
  }
}
