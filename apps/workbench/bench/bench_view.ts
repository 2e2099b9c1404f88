// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The bench: a product in a hand, moved by gizmo and numbers, with the contact as the server finds it.
import { Api, OwnHand, ShelvedProduct } from "./api";
import { Autosave } from "./autosave";
import { Opened, Result } from "./bench_answers";
import { BenchElements, benchElements, benchPage } from "./bench_page";
import { Pose, BenchState, firstState, needsOpening, openRequest, poseMembers, stateRequest } from "./bench_state";
import { colourBar } from "./colour_bar";
import { el, fill, saveText } from "./dom";
import { FiguresPanel } from "./figures_panel";
import { info } from "./info";
import { HistoryStrip } from "./history_strip";
import { History, kMostKeptSteps } from "./kept_steps";
import { Answer, LiveChannel, measured } from "./live_channel";
import { FieldFrame, Frame, Place, Triple } from "./live_frame";
import { PosePanel } from "./pose_panel";
import { benchLanguage, decimal, say, sidesText } from "./say";
import { BenchScene, Offset, Pointed } from "./scene";
import { SnapPanel } from "./snap";
import { stationAt } from "./part_line";
import { projectEnding, projectText } from "./project";
import { UndoStack } from "./undo";

/// The axis of the product that a direction is nearest to: "+z".
function directionWords(direction: Triple): string {
  const sizes = direction.map(Math.abs);
  const axis = sizes.indexOf(Math.max(...sizes));
  return (direction[axis] < 0 ? "−" : "+") + "xyz"[axis];
}

/// With what a bench begins.
export interface BenchStart {
  product: ShelvedProduct;
  project: string; // name under which it is kept by itself
  state: BenchState | null; // null: the first hold
  history: History | null;
}

export class BenchView {
  private readonly undo = new UndoStack<BenchState>();
  private state: BenchState;
  private shown: BenchState | null = null; // what the server has open
  private opened: Opened | null = null;
  private previews: FieldFrame[] = [];
  private isNew = true; // nothing of what was opened last is shown yet
  private pose: Pose | null = null; // as it is seen
  private wantedForce: number | null | undefined; // while the slider moves
  private isWorking = false;
  private what = ""; // that was asked for last
  private isStepping = false; // by undo or redo: no new step

  private readonly channel: LiveChannel;
  private readonly scene: BenchScene;
  private readonly figures = new FiguresPanel();
  private readonly posing: PosePanel;
  private readonly snapping = new SnapPanel((at, isOver) => this.snapped(at, isOver));
  private held: { centre: Triple; axis: Triple } | null = null; // where the hold has its part, hand frame
  private readonly product: ShelvedProduct;
  private readonly autosave: Autosave;
  private readonly steps = new HistoryStrip((index) => this.goTo(index));
  private readonly section: HTMLElement;
  private readonly els: BenchElements;

  /// `kept`: with every step, so that the page can be loaded again.
  constructor(root: HTMLElement, private readonly api: Api, private readonly start: BenchStart,
              back: () => void, private readonly kept: (state: BenchState) => void) {
    this.product = start.product;
    this.state = start.state ?? firstState(start.product.key);
    if (start.history) this.undo.restore(start.history.steps, start.history.at);
    this.autosave = new Autosave(api, start.project, (problem) => this.tellKept(problem));
    this.posing = new PosePanel({
      offset: (offset, isOver) => this.moved(offset, isOver),
      angles: (degrees, isOver) => this.bent(degrees, isOver),
    });
    const actions = {
      back, step: (which: "undo" | "redo") => this.step(which), chooseHolder: () => this.chooseHolder(),
      force: (newtons: number | null) => this.force(newtons), setMode: (mode: "translate" | "rotate") => this.setMode(mode),
      act: (what: "close" | "rest") => this.act(what), again: () => this.again(), saveProject: () => void this.saveProject(),
    };
    this.els = benchElements(actions);
    fill(this.els.title, el("strong", {}, this.product.file_name));
    this.section = benchPage(root, this.els, actions, {
      totals: this.figures.totals, regions: this.figures.table, place: this.posing.place, snap: this.snapping.element, joints: this.posing.jointsElement, steps: this.steps.element,
    });
    this.scene = new BenchScene(this.section, (isOver) => this.gizmoMoved(isOver));
    this.scene.onPointed((pointed) => this.tellPoint(pointed));
    this.section.querySelector("[data-product]")!.addEventListener("change", () => this.scene.paint());
    document.addEventListener("keydown", this.keys);
    void api.hands().then((hands) => this.addHands(hands), () => {});
    this.status(say("bench.opening", { file: this.product.file_name }));
    const place = location.protocol === "https:" ? "wss" : "ws";
    this.channel = new LiveChannel(`${place}://${location.host}/api/live?token=${encodeURIComponent(api.token)}`, {
      frame: (frame) => this.frame(frame),
      answer: (answer) => this.answer(answer),
      connected: (isConnected) => this.connected(isConnected),
    });
  }

  close(): void {
    document.removeEventListener("keydown", this.keys);
    this.channel.close();
    this.scene.close();
  }

  /// What stands on the bench, to go on elsewhere (another language).
  get current(): BenchStart {
    return { ...this.start, state: this.state, history: this.undo.steps(kMostKeptSteps) };
  }

  // Hands that were made here.
  private addHands(hands: OwnHand[]): void {
    this.els.person.append(...hands.map((one) => el("option", { value: `hand:${one.key}` }, say("hand.own", { name: one.name }))));
    this.els.person.value = this.state.holder.person;
  }

  // --- the page

  private readonly keys = (event: KeyboardEvent): void => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase();
    const name = key === "y" || (key === "z" && event.shiftKey) ? "redo" : key === "z" ? "undo" : null;
    if (!name) return;
    event.preventDefault();
    this.step(name);
  };

  private status(text: string, kind = ""): void {
    this.els.status.textContent = text;
    this.els.status.className = `status ${kind}`;
  }

  private working(share: number | null): void {
    this.isWorking = share !== null;
    this.els.busy.hidden = share === null;
    this.section.dataset.working = String(this.isWorking);
    if (share !== null) this.status(say("bench.working", { percent: Math.round(100 * share) }));
  }

  private tellKept(problem: string): void {
    this.els.kept.textContent = problem ? "" : say("bench.kept");
    this.section.dataset.kept = String(Number(this.section.dataset.kept ?? 0) + (problem ? 0 : 1));
    this.els.unkept.hidden = problem === "" || !this.els.lost.hidden;
    this.els.unkept.textContent = say("bench.not_kept", { message: problem });
  }

  private setMode(mode: "translate" | "rotate"): void {
    this.scene.setMode(mode);
    for (const button of this.section.querySelectorAll<HTMLElement>("[data-mode]")) {
      button.setAttribute("aria-pressed", String(button.dataset.mode === mode));
    }
  }

  private tellPoint(pointed: Pointed | null): void {
    const line = this.els.point;
    if (!pointed) {
      line.textContent = say("bench.hint");
      return;
    }
    const place = pointed.place.map((x) => decimal(x, 1)).join("; ");
    const pressure = pointed.pressure === null ? "" : decimal(1000 * pointed.pressure, 1);
    if (pointed.region !== null) {
      line.textContent = say("bench.point", { region: this.figures.regions[pointed.region]?.words ?? "", pressure, place });
    } else {
      line.textContent = pressure ? say("bench.point_product", { pressure, place }) : say("bench.point_product_moving", { place });
    }
  }

  // --- what the server says

  private connected(isConnected: boolean): void {
    this.els.lost.hidden = isConnected;
    this.section.dataset.connected = String(isConnected);
    if (!isConnected) {
      this.working(null);
      return;
    }
    this.shown = null;
    this.bring();
  }

  private frame(frame: Frame): void {
    const start = performance.now();
    switch (frame.kind) {
      case "hand":
        this.previews = [];
        this.scene.setHand(frame, this.state.holder.left);
        return;
      case "product":
        this.scene.setProduct(frame);
        return;
      case "footprint":
        this.scene.setFootprint(frame);
        return;
      case "preview":
        this.previews.push(frame);
        return;
      case "moving":
        this.scene.setField(frame, false);
        this.figures.show(frame);
        this.section.dataset.field = "moving";
        measured("palmar-show", start);
        return;
      case "rest":
        this.scene.setField(frame, this.what === "evaluate");
        if (this.state.gripForce === null && this.what === "hold") this.showForce(Math.round(frame.gripForce));
        this.figures.show(frame);
        this.posing.setAngles(frame.postureDeg);
    }
  }

  private answer(answer: Answer): void {
    switch (answer.say) {
      case "progress":
        this.working(answer.share as number);
        return;
      case "opened":
        this.takeOpened(answer as Opened);
        return;
      case "result":
        this.takeResult(answer as Result);
        return;
      case "error":
        this.working(null);
        this.status(say("bench.failed", { message: String(answer.message) }), "bad");
        return;
      case "dropped":
    }
  }

  private takeOpened(opened: Opened): void {
    this.opened = opened;
    this.figures.regions = opened.hand.regions;
    this.posing.setHand(opened.hand.angles);
    this.scene.setColours(opened.colours);
    const isLeft = opened.hand.side === "left"; // of an own hand it wasn't known before
    this.scene.setLeft(isLeft);
    this.els.hint.textContent = say(isLeft ? "bench.place_hint_left" : "bench.place_hint");
    const product = opened.product;
    fill(this.els.title, el("strong", {}, product.file_name),
      el("span", { class: "soft" }, say("bench.size", { sides: sidesText(product.sides_mm ?? []), triangles: product.triangles ?? 0 })),
      (product.notes?.length ?? 0) > 0 && el("details", { class: "notes" }, el("summary", {}, say("bench.notes")), el("ul", {}, product.notes!.map((note) => el("li", {}, note)))));
    const pictures = this.previews.length > 0 ? this.scene.thumbnails(this.previews, isLeft) : [];
    this.previews = [];
    fill(this.els.holds, opened.holds.length === 0 && el("li", { class: "soft" }, say("bench.no_holds")),
      opened.holds.map((hold, k) => el("li", {}, el("button", {
        type: "button", class: "hold", "data-hold": hold.number, "aria-pressed": "false", onclick: () => this.chooseHold(hold.number),
      }, el("img", { src: pictures[k] ?? "", alt: "", width: 264, height: 168 }),
      el("strong", {}, say("bench.hold", { number: hold.number })), el("span", {}, hold.words),
      el("span", { class: "soft" }, say("bench.thumb_towards", { direction: directionWords(hold.thumb_towards) })),
      hold.against && el("span", { class: "soft" }, hold.against)))));
    this.snapping.show(opened.parts);
    this.held = null;
    this.section.dataset.opened = product.key;
    if (opened.holds.length > 0 || this.state.pose) this.bring();
    else this.working(null);
  }

  private takeResult(result: Result): void {
    const one = result.assessment.assessments[0];
    const place: Place = {
      quaternion: result.posture.product_from_hand.quaternion_wxyz as Place["quaternion"],
      translation: result.posture.product_from_hand.translation_mm as Triple,
    };
    const angles = this.opened?.hand.angles ?? [];
    this.pose = { postureDeg: angles.map((angle) => result.posture.posture[`${angle.name}_deg`]), place, grip: result.posture.grip };
    // Offsets count from where the product came to rest last.
    if (this.what !== "evaluate" || this.isNew) this.scene.setBase(place, one.contact.centre_mm);
    this.posing.setOffset(this.scene.offset());
    if (this.what !== "evaluate" || this.held === null) this.noteHeld();
    this.scene.setUpper(result.upper_mpa);
    if (this.opened) this.els.bar.innerHTML = colourBar(this.opened.colours, 1000 * result.upper_mpa);
    if (this.isNew) this.scene.lookAtHand();
    this.isNew = false;
    this.working(null);
    const isPlaced = this.what === "evaluate";
    this.status(say(isPlaced ? "bench.as_placed" : "bench.at_rest"), isPlaced ? "fair" : "");
    // A pose that was set by hand is judged as it stands, not as a hold.
    const tone = isPlaced && one.verdict.held === "held" ? "fair"
      : { held: "good", doubtful: "fair", not_held: "bad" }[one.verdict.held] ?? "";
    this.els.verdict.className = `verdict ${tone}`;
    fill(this.els.verdict, el("p", { class: "sentence" }, result.assessment.verdict.sentence || one.grasp.message, " ", info("held")),
      result.assessment.verdict.reasons.length > 0 && el("details", {}, el("summary", {}, say("bench.why")), el("ul", {}, result.assessment.verdict.reasons.map((reason) => el("li", {}, reason)))));
    this.showCommand(result);
    this.section.dataset.field = isPlaced ? "placed" : "rest";
    this.section.dataset.results = String(Number(this.section.dataset.results ?? 0) + 1);
    this.keep();
    this.showState();
    if (this.wantedForce !== undefined) {
      const wanted = this.wantedForce;
      this.wantedForce = undefined;
      if (wanted !== this.state.gripForce) this.force(wanted);
    }
  }

  private showCommand(result: Result): void {
    const copy = el("button", { type: "button", class: "copy", onclick: () => {
      void navigator.clipboard?.writeText(result.command);
      copy.textContent = say("bench.copied");
    } }, say("bench.copy"));
    const made = this.opened?.product.made_by;
    if (!result.command) {
      fill(this.els.command, el("p", { class: "soft" }, say("bench.no_command")));
      return;
    }
    fill(this.els.command, made ? [el("p", { class: "soft" }, say("bench.make_first")), el("code", {}, made)] : null,
      el("code", { "data-command": true }, result.command), copy,
      !result.is_hold && el("button", { type: "button", class: "copy", onclick: () => saveText("posture.json", JSON.stringify(result.posture, null, 2)) }, say("bench.posture_file")));
  }

  // --- what a person does

  private ask(what: string, request: Parameters<LiveChannel["ask"]>[0]): void {
    this.what = what;
    this.working(0);
    this.channel.ask(request);
  }

  /// Brings about what `state` says.
  private bring(): void {
    if (needsOpening(this.shown, this.state)) {
      this.shown = this.state;
      this.isNew = true;
      this.ask("open", openRequest(this.state, benchLanguage()));
      return;
    }
    this.shown = this.state;
    const request = stateRequest(this.state);
    this.ask(request.do, request);
  }

  private keep(): void {
    if (!this.isStepping) this.undo.push(this.state, () => this.scene.miniature());
    this.isStepping = false;
    this.kept(this.state);
    this.autosave.keep(this.state, this.undo.steps(kMostKeptSteps));
    this.steps.show(this.undo.pictures, this.undo.at);
    this.els.undo.disabled = !this.undo.canUndo();
    this.els.redo.disabled = !this.undo.canRedo();
  }

  private async saveProject(): Promise<void> {
    try {
      const bytes = await this.api.file(this.product.key);
      const name = this.product.file_name;
      const own = this.state.holder.person.startsWith("hand:") ? await this.api.handFile(this.state.holder.person.slice(5)) : null;
      const state = own ? { ...this.state, holder: { ...this.state.holder, person: "" } } : this.state;
      saveText(name.replace(/\.[^.]*$/, "") + projectEnding, projectText({ fileName: name, unit: this.product.unit, bytes, state, hand: own }));
    } catch (error) {
      this.status(say("bench.failed", { message: String(error) }), "bad");
    }
  }

  private step(which: "undo" | "redo"): void {
    this.goTo(this.undo.at + (which === "undo" ? -1 : 1));
  }

  private goTo(index: number): void {
    const state = this.undo.goTo(index);
    if (!state) return;
    this.state = state;
    this.isStepping = true;
    this.showState();
    this.bring();
  }

  private showState(): void {
    const { els, state } = this;
    els.person.value = state.holder.person;
    els.side.value = state.holder.left ? "left" : "right";
    els.usual.checked = state.gripForce === null;
    if (state.gripForce !== null && this.wantedForce === undefined) this.showForce(state.gripForce);
    for (const button of els.holds.querySelectorAll<HTMLElement>("[data-hold]")) {
      button.setAttribute("aria-pressed", String(Number(button.dataset.hold) === state.hold && state.pose === null));
    }
    this.section.dataset.state = JSON.stringify({ ...state, pose: state.pose ? state.settle ?? "placed" : null });
  }

  private showForce(force: number): void {
    if (document.activeElement !== this.els.force || this.wantedForce === undefined) this.els.force.value = String(force);
    if (document.activeElement !== this.els.forceNumber) this.els.forceNumber.value = String(force);
  }

  private chooseHold(number: number): void {
    this.isStepping = false;
    this.state = { ...this.state, hold: number, pose: null, settle: null };
    this.showState();
    this.bring();
  }

  private again(): void {
    this.chooseHold(this.state.hold);
  }

  private chooseHolder(): void {
    this.isStepping = false;
    const holder = { person: this.els.person.value, left: this.els.side.value === "left" };
    // A pose is one hand's own; another hand takes the hold.
    this.state = { ...this.state, holder, pose: null, settle: null };
    this.showState();
    this.bring();
  }

  private force(force: number | null): void {
    if (force !== null && !(force >= 1 && force <= 1000)) return;
    if (force !== null) this.showForce(force);
    if (this.isWorking) { // when that is there
      this.wantedForce = force;
      return;
    }
    this.isStepping = false;
    // A pose that was set by hand has the force that it has: it comes to rest with another.
    this.state = { ...this.state, gripForce: force, settle: this.state.pose ? this.state.settle ?? "rest" : null };
    this.showState();
    this.bring();
  }

  private act(what: "close" | "rest"): void {
    const pose = this.seenPose();
    if (!pose) return;
    this.isStepping = false;
    this.state = { ...this.state, pose, settle: what };
    this.showState();
    this.bring();
  }

  private seenPose(): Pose | null {
    return this.pose ? { ...this.pose, place: this.scene.place() } : null;
  }

  private gizmoMoved(isOver: boolean): void {
    this.posing.setOffset(this.scene.offset());
    this.goOn(isOver);
  }

  private moved(offset: Offset, isOver: boolean): void {
    if (!this.pose) return;
    this.scene.setOffset(offset);
    this.goOn(isOver);
  }

  // Where the part that is held lies at rest; what is snapped comes there.
  private noteHeld(): void {
    const hold = this.opened?.holds.find((one) => one.number === this.state.hold);
    const part = this.opened?.parts.find((one) => one.number === hold?.part && one.line.length > 0);
    this.held = part && hold ? this.scene.inHand(stationAt(part.line, hold.along)) : null;
  }

  private snapped(at: { centre: Triple; axis: Triple }, isOver: boolean): void {
    if (!this.pose || !this.held) return;
    this.scene.snap(at, this.held);
    this.posing.setOffset(this.scene.offset());
    this.goOn(isOver);
  }

  private bent(degrees: number[], isOver: boolean): void {
    if (!this.pose) return;
    this.pose = { ...this.pose, postureDeg: degrees };
    this.goOn(isOver);
  }

  /// The contact follows; what stands when it is over is evaluated in full.
  private goOn(isOver: boolean): void {
    const pose = this.seenPose();
    if (!pose) return;
    this.isStepping = false;
    if (!isOver) {
      this.status(say("bench.moving"), "fair");
      this.els.verdict.className = "verdict stale"; // of what stood there before
      this.els.busy.hidden = true;
      this.isWorking = false;
      this.channel.move({ do: "move", ...poseMembers(pose) });
      return;
    }
    this.state = { ...this.state, pose, settle: null };
    this.showState();
    this.bring();
  }
}
