// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Creases and dots that were found on a person's scans, to be named, dragged, taken away, added.
import { PLYLoader } from "three/examples/jsm/loaders/PLYLoader.js";
import { Api, Job } from "./api";
import { CorrectionRow, Corrections, parseMarks, Triple } from "./corrections";
import { el, fill } from "./dom";
import { FoundMark, FoundScene } from "./found_scene";
import { creaseNames, dotNames, postures } from "./hand_names";
import { namedWords } from "./hand_words";
import { decimal, say } from "./say";

const kUnused = 0x5d666f, kCrease = 0x1d7a4a, kDot = 0x0b63c5, kChanged = 0xc8237c;

export class MarksView {
  readonly element: HTMLElement;
  private readonly shown: HTMLSelectElement;
  private readonly list = el("ul", { class: "marks", "aria-label": say("found.marks") });
  private readonly words = el("p", { class: "status", role: "status" });
  private readonly again: HTMLButtonElement;
  private readonly adding = el("select", { "aria-label": say("found.add") });
  private scene: FoundScene | null = null;
  private corrections = new Corrections([]);
  private selected: string | null = null;
  private drawn: string | null = null; // crease that goes on with the next point
  private isClosed = false;

  constructor(private readonly api: Api, private readonly job: Job, private readonly revise: (rows: CorrectionRow[]) => void) {
    const there = postures.filter((one) => job.made.includes(`found/scan_${one}.ply`));
    this.shown = el("select", { "aria-label": say("found.posture"), onchange: () => void this.showPosture() }, there.map((one) => el("option", { value: one }, say(`found.posture.${one}` as "found.posture.reference"))));
    this.again = el("button", { type: "button", class: "primary", disabled: true, "data-found": "again", onclick: () => this.revise(this.corrections.rows()) }, say("found.again"));
    fill(this.adding, el("option", { value: "" }, say("found.add")), el("option", { value: "dot" }, say("found.add_dot")), el("option", { value: "crease" }, say("found.add_crease")));
    this.adding.addEventListener("change", () => { this.drawn = null; this.tell(); });
    const look = (name: "palm" | "back") => el("button", { type: "button", "data-look": name }, say(`bench.look_${name}`));
    this.element = el("section", { class: "found", "aria-label": say("found.heading") },
      el("div", { class: "shape" },
        el("div", { class: "tools" }, el("label", {}, say("found.posture"), this.shown), look("back"), look("palm"), this.adding,
          el("button", { type: "button", "data-save": "palmar-found" }, say("bench.picture"))),
        el("div", { class: "view" }, el("div", { class: "view-canvas", "data-label": say("found.heading") })), this.words),
      el("aside", {}, el("h2", {}, say("found.marks")), el("p", { class: "soft" }, say("found.about")), this.again, this.list));
  }

  close(): void {
    this.isClosed = true;
    this.scene?.stage.dispose();
  }

  async load(): Promise<void> {
    try {
      const csv = new TextDecoder().decode(await this.api.bytes(this.job.key, "made?file=found%2Fmarks.csv"));
      if (this.isClosed) return;
      this.corrections = new Corrections(parseMarks(csv), this.job.request.corrections ?? []);
      this.scene = new FoundScene(this.element.querySelector<HTMLElement>(".shape")!, {
        picked: (mark, _body, place) => this.picked(mark, place),
        dragged: (mark, place, isOver) => this.dragged(mark, place, isOver),
      });
      await this.showPosture();
    } catch (error) {
      this.words.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
    }
  }

  private get posture(): string { return this.shown.value; }

  private async showPosture(): Promise<void> {
    const bytes = await this.api.bytes(this.job.key, `made?file=${encodeURIComponent(`found/scan_${this.posture}.ply`)}`);
    if (this.isClosed || !this.scene) return;
    const geometry = new PLYLoader().parse(bytes);
    geometry.computeVertexNormals();
    this.scene.show([{ name: "skin", geometry }]);
    this.turn();
    this.select(null);
    this.showMarks();
    this.element.dataset.ready = this.posture;
  }

  // Fingertips up: from the wrist's crease to the mean of the others, the back towards the viewer.
  private turn(): void {
    const mean = (all: Triple[]) => [0, 1, 2].map((k) => all.reduce((sum, one) => sum + one[k], 0) / Math.max(1, all.length)) as Triple;
    const of = (is: (name: string) => boolean) => mean(this.here().filter((one) => is(one.newName)).map((one) => one.newPlace));
    const minus = (a: Triple, b: Triple) => a.map((one, k) => one - b[k]) as Triple;
    const unit = (a: Triple) => { const size = Math.hypot(...a) || 1; return a.map((one) => one / size) as Triple; };
    const cross = (a: Triple, b: Triple): Triple => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const distal = unit(minus(of((name) => name.endsWith("_distal") && !name.startsWith("thumb")), of((name) => name === "wrist" || name === "palm")));
    const dots = mean(this.here().filter((one) => one.kind === "dot").map((one) => one.newPlace));
    const creases = mean(this.here().filter((one) => one.kind === "crease" && one.newName !== "wrist").map((one) => one.newPlace));
    const out = minus(creases, dots), along = out.reduce((sum, one, k) => sum + one * distal[k], 0);
    const palmward = unit(out.map((one, k) => one - along * distal[k]) as Triple);
    if ([...distal, ...palmward].every(Number.isFinite) && Math.hypot(...distal) > 0.5 && Math.hypot(...palmward) > 0.5) {
      this.scene!.setSides(palmward, distal, unit(cross(distal, palmward)));
    }
  }

  private here() { return this.corrections.marks.filter((one) => one.posture === this.posture); }

  private showMarks(): void {
    const marks: FoundMark[] = [];
    for (const one of this.here()) {
      const isGone = one.newName === "" || one.newName === "none";
      const colour = this.corrections.isChanged(one.id) ? kChanged : isGone ? kUnused : one.kind === "dot" ? kDot : kCrease;
      const radius = isGone ? 0.9 : 1.5;
      marks.push({ id: one.id, place: one.newPlace, colour, radius });
      one.points.slice(1).forEach((place, k) => marks.push({ id: `${one.id}.${k}`, place, colour, radius }));
    }
    this.scene?.setMarks(marks);
    fill(this.list, this.here().map((one) => this.row(one.id)));
    const changes = this.corrections.changes;
    this.again.disabled = changes === 0;
    this.element.dataset.changes = String(changes);
    this.tell();
  }

  private row(id: string): HTMLElement {
    const mark = this.corrections.find(id)!;
    const names = mark.kind === "crease" ? creaseNames : dotNames;
    const select = el("select", { "aria-label": say(`found.${mark.kind}`), "data-mark": id, onchange: () => { this.corrections.rename(id, select.value); this.showMarks(); this.select(id); } },
      el("option", { value: "none" }, say("found.name.none")), names.map((name) => el("option", { value: name }, namedWords(name))));
    select.value = mark.newName || "none";
    const numbers = (mark.kind === "dot" || mark.isAdded) && mark.points.length < 2 && el("span", { class: "place" }, mark.newPlace.map((value, k) => {
      const input = el("input", { type: "number", step: 0.5, value: Math.round(10 * value) / 10, "aria-label": `${say(`found.${mark.kind}`)}, ${"xyz"[k]}, mm`,
        onchange: () => { const place = [...mark.newPlace] as Triple; place[k] = Number(input.value); this.corrections.move(id, place); this.showMarks(); this.select(id); } });
      return input;
    }));
    const row = el("li", { "data-row": id, class: this.corrections.isChanged(id) ? "is-changed" : "" },
      el("span", { class: `kind ${mark.kind}` }, say(`found.${mark.kind}`)), select,
      el("button", { type: "button", "aria-label": say("found.remove"), title: say("found.remove"), onclick: () => { this.corrections.remove(id); this.showMarks(); } }, "×"), numbers || null);
    row.addEventListener("focusin", () => this.select(id));
    return row;
  }

  private tell(): void {
    const mark = this.selected ? this.corrections.find(this.selected) : undefined;
    if (this.adding.value) this.words.textContent = say(this.adding.value === "dot" ? "found.click_dot" : "found.click_crease");
    else if (mark) this.words.textContent = say("found.selected", { kind: say(`found.${mark.kind}`), name: namedWords(mark.newName || "none"), place: mark.newPlace.map((x) => decimal(x, 1)).join("; ") });
    else this.words.textContent = say("found.hint", { dots: this.here().filter((one) => one.kind === "dot" && one.newName && one.newName !== "none").length, creases: this.here().filter((one) => one.kind === "crease" && one.newName && one.newName !== "none").length });
  }

  private select(id: string | null): void {
    this.selected = id;
    this.scene?.select(id);
    for (const row of this.list.querySelectorAll<HTMLElement>("[data-row]")) {
      row.classList.toggle("is-selected", row.dataset.row === id);
    }
    const mark = id ? this.corrections.find(id) : undefined;
    this.element.dataset.seen = mark && this.scene ? JSON.stringify(this.scene.seenAt(mark.newPlace)) : "";
    this.tell();
  }

  private picked(mark: string | null, place: Triple | null): void {
    if (mark) {
      const id = mark.split(".")[0];
      this.select(id);
      this.list.querySelector(`[data-row="${id}"]`)?.scrollIntoView({ block: "nearest" });
      return;
    }
    const kind = this.adding.value as "" | "dot" | "crease";
    if (!place || !kind) return this.select(null);
    if (kind === "crease" && this.drawn && this.corrections.find(this.drawn)) this.corrections.extend(this.drawn, place);
    else this.drawn = this.corrections.add(this.posture, kind, kind === "dot" ? "palm" : "wrist", place);
    this.showMarks();
    this.select(this.drawn);
  }

  private dragged(mark: string, place: Triple, isOver: boolean): void {
    const id = mark.split(".")[0];
    if (this.corrections.find(id)?.kind === "crease" && !this.corrections.find(id)?.isAdded) {
      if (!isOver) return;
      this.showMarks(); // back where it was
      this.words.textContent = say("found.crease_stays");
      return;
    }
    this.corrections.move(id, place);
    if (isOver) { this.showMarks(); this.select(id); }
  }
}
