// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The bench: a product in a hand, moved by gizmo and numbers, with the contact as the server finds it.
import { Pose, BenchState, needsOpening, openRequest, poseMembers, stateRequest } from "./bench_state";
import { colourBar } from "./colour_bar";
import { el, fill, saveText } from "./dom";
import { FiguresPanel, RegionName } from "./figures_panel";
import { Answer, LiveChannel, measured } from "./live_channel";
import { FieldFrame, Frame, Place, Triple } from "./live_frame";
import { Angle, PosePanel } from "./pose_panel";
import { benchLanguage, decimal, say, TextKey } from "./say";
import { BenchScene, Colours, Offset, Pointed } from "./scene";
import { projectEnding, projectText } from "./project";
import { Api, ShelvedProduct, sidesText } from "./start_view";
import { UndoStack } from "./undo";

interface OpenedHold {
  number: number;
  words: string;
  against: string;
  score: number | null;
  grip: string;
  thumb_towards: Triple; // product frame
}

interface Opened extends Answer {
  product: ShelvedProduct;
  hand: { name: string; side: string; angles: Angle[]; regions: RegionName[] };
  holds: OpenedHold[];
  colours: Colours;
}

interface Result extends Answer {
  is_hold: boolean;
  command: string;
  posture: { posture: Record<string, number>; product_from_hand: { quaternion_wxyz: number[]; translation_mm: number[] }; grip: string };
  upper_mpa: number;
  hold_words: string;
  assessment: {
    assessments: {
      verdict: { held: string; sentence: string };
      grasp: { message: string; grip: string };
      contact: { centre_mm: Triple; message: string };
      doubts?: { words: string }[];
    }[];
    verdict: { sentence: string; reasons: string[] };
  };
}

const people = ["", "woman:P5", "woman:P50", "woman:P95", "man:P5", "man:P50", "man:P95"];
const kUsualShown = 107; // N; what the slider shows until the server says what the usual force is
const kMostForce = 250; // N

function personWords(person: string): string {
  if (!person) return say("bench.template");
  const [sex, percentile] = person.split(":P");
  return say(`bench.${sex}` as TextKey, { percentile });
}

/// The axis of the product that a direction is nearest to: "+z".
function directionWords(direction: Triple): string {
  const sizes = direction.map(Math.abs);
  const axis = sizes.indexOf(Math.max(...sizes));
  return (direction[axis] < 0 ? "−" : "+") + "xyz"[axis];
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
  private readonly section: HTMLElement;
  private readonly els = {
    holds: el("ol", { class: "holds" }),
    verdict: el("div", { class: "verdict", role: "status" }),
    status: el("p", { class: "status", role: "status" }),
    point: el("p", { class: "point" }, say("bench.hint")),
    bar: el("div", { class: "view-bar" }),
    command: el("div", { class: "command" }),
    undo: el("button", { type: "button", disabled: true, onclick: () => this.step("undo") }, say("bench.undo")),
    redo: el("button", { type: "button", disabled: true, onclick: () => this.step("redo") }, say("bench.redo")),
    person: el("select", { "aria-label": say("bench.who"), onchange: () => this.chooseHolder() }),
    side: el("select", { "aria-label": `${say("bench.right")}, ${say("bench.left")}`, onchange: () => this.chooseHolder() }),
    force: el("input", { type: "range", min: 5, max: kMostForce, step: 1, value: kUsualShown, "aria-label": `${say("bench.force")}, N` }),
    forceNumber: el("input", { type: "number", min: 1, max: 1000, step: 1, "aria-label": `${say("bench.force")}, N` }),
    usual: el("input", { type: "checkbox", checked: true }),
    busy: el("div", { class: "busy", hidden: true }),
    lost: el("p", { class: "lost", role: "alert", hidden: true }, say("bench.lost")),
    hint: el("p", { class: "soft" }, say("bench.place_hint")),
    title: el("div", { class: "title" }),
  };

  /// `kept`: with every step, so that the page can be loaded again.
  constructor(root: HTMLElement, private readonly api: Api, private readonly product: ShelvedProduct, start: BenchState | null,
              back: () => void, private readonly kept: (state: BenchState) => void) {
    this.state = start ?? { product: product.key, holder: { person: "", left: false }, gripForce: null, hold: 1, pose: null, settle: null };
    this.posing = new PosePanel({
      offset: (offset, isOver) => this.moved(offset, isOver),
      angles: (degrees, isOver) => this.bent(degrees, isOver),
    });
    this.section = this.page(root, product, back);
    this.scene = new BenchScene(this.section, (isOver) => this.gizmoMoved(isOver));
    this.scene.onPointed((pointed) => this.tellPoint(pointed));
    this.section.querySelector("[data-product]")!.addEventListener("change", () => this.scene.paint());
    document.addEventListener("keydown", this.keys);
    this.status(say("bench.opening", { file: product.file_name }));
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
  }

  /// What stands on the bench, to go on elsewhere (another language).
  get current(): BenchState { return this.state; }

  // --- the page

  private page(root: HTMLElement, product: ShelvedProduct, back: () => void): HTMLElement {
    const { els } = this;
    fill(els.person, people.map((person) => el("option", { value: person }, personWords(person))));
    fill(els.side, el("option", { value: "right" }, say("bench.right")), el("option", { value: "left" }, say("bench.left")));
    const forceChanged = (from: HTMLInputElement) => () => {
      els.usual.checked = false;
      this.force(Number(from.value));
    };
    els.force.addEventListener("input", forceChanged(els.force));
    els.forceNumber.addEventListener("change", forceChanged(els.forceNumber));
    els.usual.addEventListener("change", () => this.force(els.usual.checked ? null : Number(els.force.value)));
    const look = (name: "palm" | "back" | "thumb" | "little") =>
      el("button", { type: "button", "data-look": name }, say(`bench.look_${name}`));
    const mode = (name: "translate" | "rotate", key: "bench.move" | "bench.turn") => el("button", {
      type: "button", "data-mode": name, "aria-pressed": name === "translate" ? "true" : "false",
      onclick: () => this.setMode(name),
    }, say(key));
    const section = el("section", { class: "bench", "aria-label": say("bench.view") },
      el("aside", { class: "left" }, el("h2", {}, say("bench.who")), el("div", { class: "who" }, els.person, els.side),
        el("h2", {}, say("bench.holds")), els.holds),
      el("div", { class: "middle" },
        el("div", { class: "tools" },
          el("span", { class: "group", role: "group", "aria-label": say("bench.look") }, el("span", { class: "soft" }, say("bench.look")), look("palm"), look("back"), look("thumb"), look("little")),
          el("label", {}, say("bench.product"), el("select", { "data-product": true },
            el("option", { value: "clear" }, say("bench.clear")), el("option", { value: "solid" }, say("bench.solid")), el("option", { value: "hidden" }, say("bench.hidden")))),
          el("label", {}, say("bench.cut"), el("input", { type: "range", "data-cut": true, min: 0, max: 100, value: 100 })),
          el("button", { type: "button", "data-save": "palmar-bench" }, say("bench.picture"))),
        el("div", { class: "view" }, el("div", { class: "view-canvas", "data-label": say("bench.view") }), els.bar, els.busy), els.status, els.point),
      el("aside", { class: "right" }, els.verdict, this.figures.totals,
        el("h2", {}, say("bench.force")),
        el("div", { class: "force" }, els.force, el("label", {}, els.forceNumber, "N"), el("label", { class: "usual" }, els.usual, say("bench.usual_force"))),
        el("h2", {}, say("bench.place")),
        el("div", { class: "buttons" }, el("span", { class: "group", role: "group" }, mode("translate", "bench.move"), mode("rotate", "bench.turn")),
          el("button", { type: "button", "data-act": "close", onclick: () => this.act("close") }, say("bench.close")),
          el("button", { type: "button", "data-act": "rest", onclick: () => this.act("rest") }, say("bench.rest")),
          el("button", { type: "button", "data-act": "again", onclick: () => this.again() }, say("bench.again"))),
        this.posing.place, els.hint,
        el("details", { class: "part", open: true }, el("summary", {}, el("h2", {}, say("bench.regions"))), this.figures.table),
        el("details", { class: "part" }, el("summary", {}, el("h2", {}, say("bench.joints"))), this.posing.jointsElement),
        el("details", { class: "part" }, el("summary", {}, el("h2", {}, say("bench.command"))), els.command)));
    fill(els.title, el("strong", {}, product.file_name));
    fill(root, el("header", { class: "top" }, el("button", { type: "button", onclick: back }, say("bench.back")), els.title,
      el("span", { class: "group" }, els.undo, els.redo, el("button", { type: "button", "data-project": true, onclick: () => void this.saveProject() }, say("bench.save")))), els.lost, section);
    return section;
  }

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
    const isLeft = opened.hand.side === "left";
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
    fill(this.els.verdict, el("p", { class: "sentence" }, result.assessment.verdict.sentence || one.grasp.message),
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
    if (!this.isStepping) this.undo.push(this.state);
    this.isStepping = false;
    this.kept(this.state);
    this.els.undo.disabled = !this.undo.canUndo();
    this.els.redo.disabled = !this.undo.canRedo();
  }

  private async saveProject(): Promise<void> {
    try {
      const bytes = await this.api.file(this.product.key);
      const name = this.product.file_name;
      saveText(name.replace(/\.[^.]*$/, "") + projectEnding, projectText({ fileName: name, unit: this.product.unit, bytes, state: this.state }));
    } catch (error) {
      this.status(say("bench.failed", { message: String(error) }), "bad");
    }
  }

  private step(which: "undo" | "redo"): void {
    const state = which === "undo" ? this.undo.undo() : this.undo.redo();
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
