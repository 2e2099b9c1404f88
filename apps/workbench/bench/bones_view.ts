// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Bones that were found in the reference MR image, to be named: a name is put on the bone that it belongs to.
import { PLYLoader } from "three/examples/jsm/loaders/PLYLoader.js";
import { Api, Job } from "./api";
import { CorrectionRow, Triple } from "./corrections";
import { el, fill } from "./dom";
import { FoundBody, FoundScene } from "./found_scene";
import { boneNames } from "./hand_names";
import { namedWords } from "./hand_words";
import { say } from "./say";

const kFolder = "found/reference/";
const kBone = 0xd8cdb4, kUnnamed = 0x9aa2aa, kSelected = 0xc8237c, kRenamed = 0x0b63c5;

export class BonesView {
  readonly element: HTMLElement;
  private readonly list = el("ul", { class: "marks", "aria-label": say("found.bones") });
  private readonly words = el("p", { class: "status", role: "status" });
  private readonly again: HTMLButtonElement;
  private readonly files: string[]; // of bones
  private readonly touched = new Map<string, { name: string; place: Triple }>(); // by the bone as it was found
  private readonly middles = new Map<string, Triple>(); // a point on each bone
  private scene: FoundScene | null = null;
  private carried: string | null = null; // a name on its way to a bone
  private isClosed = false;

  constructor(private readonly api: Api, private readonly job: Job, private readonly revise: (rows: CorrectionRow[]) => void) {
    this.files = job.made.filter((one) => one.startsWith(`${kFolder}bones/`) && one.endsWith(".ply"));
    this.again = el("button", { type: "button", class: "primary", disabled: true, "data-found": "again", onclick: () => this.revise(this.rows()) }, say("found.again"));
    const look = (name: "palm" | "back") => el("button", { type: "button", "data-look": name }, say(`bench.look_${name}`));
    this.element = el("section", { class: "found", "aria-label": say("found.heading") },
      el("div", { class: "shape" }, el("div", { class: "tools" }, look("back"), look("palm"), el("button", { type: "button", "data-save": "palmar-found" }, say("bench.picture"))),
        el("div", { class: "view" }, el("div", { class: "view-canvas", "data-label": say("found.heading") })), this.words),
      el("aside", {}, el("h2", {}, say("found.bones")), el("p", { class: "soft" }, say("found.about_bones")), this.again, this.list));
  }

  close(): void {
    this.isClosed = true;
    this.scene?.stage.dispose();
  }

  private nameOf(file: string): string { return file.slice(kFolder.length + 6, -4); }

  async load(): Promise<void> {
    try {
      const read = async (file: string) => {
        const geometry = new PLYLoader().parse(await this.api.bytes(this.job.key, `made?file=${encodeURIComponent(file)}`));
        geometry.computeVertexNormals();
        return geometry;
      };
      const bodies: FoundBody[] = [];
      for (const file of this.files) {
        const geometry = await read(file), name = this.nameOf(file), at = geometry.getAttribute("position");
        geometry.computeBoundingBox();
        this.middles.set(name, [at.getX(0), at.getY(0), at.getZ(0)]);
        bodies.push({ name, geometry, colour: boneNames.includes(name) ? kBone : kUnnamed });
      }
      if (this.job.made.includes(`${kFolder}skin.ply`)) bodies.push({ name: "skin", geometry: await read(`${kFolder}skin.ply`), opacity: 0.18, isTarget: false });
      if (this.isClosed) return;
      this.scene = new FoundScene(this.element.querySelector<HTMLElement>(".shape")!, { picked: (_mark, bone, place) => this.picked(bone, place), dragged: () => {} });
      this.scene.show(bodies);
      // A drag of a name ends where the pointer is over a bone.
      const canvas = this.scene.stage.controls.domElement as HTMLElement;
      canvas.addEventListener("dragover", (event) => event.preventDefault());
      canvas.addEventListener("drop", (event) => this.dropped(event as DragEvent));
      this.showList();
      this.element.dataset.ready = "reference";
    } catch (error) {
      this.words.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
    }
  }

  private showList(): void {
    fill(this.list, this.files.map((file) => {
      const found = this.nameOf(file), now = this.touched.get(found)?.name ?? found;
      const select: HTMLSelectElement = el("select", { "data-bone": found, "aria-label": say("found.bone"), onchange: () => this.rename(found, select.value, this.middles.get(found)!) },
        !boneNames.includes(found) && el("option", { value: found }, say("found.unnamed", { name: found })), boneNames.map((name) => el("option", { value: name }, namedWords(name))));
      select.value = now;
      const handle = el("span", { class: "handle", draggable: "true", title: say("found.drag_name"), ondragstart: (event) => { this.carried = now; (event as DragEvent).dataTransfer?.setData("text/plain", now); } }, "⠿");
      const row = el("li", { "data-row": found, class: now === found ? "" : "is-changed" }, handle, select);
      row.addEventListener("focusin", () => this.light(found));
      row.addEventListener("pointerenter", () => this.light(found));
      return row;
    }));
    this.again.disabled = this.touched.size === 0;
    this.element.dataset.changes = String(this.touched.size);
    this.words.textContent = say("found.hint_bones", { bones: this.files.length });
  }

  private light(bone: string | null): void {
    for (const file of this.files) {
      const name = this.nameOf(file);
      this.scene?.colour(name, name === bone ? kSelected : this.touched.has(name) ? kRenamed : boneNames.includes(name) ? kBone : kUnnamed);
    }
    for (const row of this.list.querySelectorAll<HTMLElement>("[data-row]")) row.classList.toggle("is-selected", row.dataset.row === bone);
  }

  private picked(bone: string | null, _place: Triple | null): void {
    this.light(bone);
    if (!bone) return;
    this.list.querySelector(`[data-row="${CSS.escape(bone)}"]`)?.scrollIntoView({ block: "nearest" });
    this.list.querySelector<HTMLElement>(`[data-bone="${CSS.escape(bone)}"]`)?.focus();
  }

  private dropped(event: DragEvent): void {
    event.preventDefault();
    const name = this.carried;
    this.carried = null;
    const hit = name ? this.scene?.bodyAt(event.clientX, event.clientY) : null;
    if (name && hit) this.rename(hit.name, name, hit.place);
  }

  // The bone that had the name so far gets the other's, so that no name is given twice.
  private rename(found: string, name: string, place: Triple): void {
    const had = this.touched.get(found)?.name ?? found;
    for (const file of this.files) {
      const other = this.nameOf(file);
      if (other !== found && (this.touched.get(other)?.name ?? other) === name) this.put(other, had, this.middles.get(other)!);
    }
    this.put(found, name, place);
    this.showList();
    this.light(found);
  }
  private put(found: string, name: string, place: Triple): void {
    if (name === found) this.touched.delete(found);
    else this.touched.set(found, { name, place });
  }

  private rows(): CorrectionRow[] {
    const names = new Set([...this.touched.values()].map((one) => one.name));
    // A bone that was named before bears that name now.
    const kept = (this.job.request.corrections ?? []).filter((one) => one.mark !== "" || !(names.has(one.name) || this.touched.has(one.name)));
    const now = [...this.touched.values()].filter((one) => boneNames.includes(one.name));
    return [...kept, ...now.map((one) => ({ posture: "", mark: "" as const, name: one.name, place_mm: one.place }))];
  }
}
