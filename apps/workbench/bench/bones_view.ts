// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Bones that were found in the reference MR image, to be named: a name is put on the bone that it belongs to.
import { Vector3 } from "three";
import { PLYLoader } from "three/examples/jsm/loaders/PLYLoader.js";
import { Api, Job } from "./api";
import { BoneNames, CorrectionRow, Triple } from "./corrections";
import { el, fill } from "./dom";
import { FoundBody, FoundScene } from "./found_scene";
import { boneNames } from "./hand_names";
import { namedWords } from "./hand_words";
import { say } from "./say";

const kFolder = "found/reference/";
const kBone = 0xd8cdb4, kUnnamed = 0x9aa2aa, kSelected = 0xc8237c, kRenamed = 0x0b63c5;


/// The bone with the vertex that is nearest to a place; `points` are coordinates one after the other.
function boneNearest(points: Map<string, ArrayLike<number>>, place: Triple): string {
  let nearest = "", least = Infinity;
  for (const [name, at] of points) {
    for (let k = 0; k < at.length; k += 3) {
      const squares = (at[k] - place[0]) ** 2 + (at[k + 1] - place[1]) ** 2 + (at[k + 2] - place[2]) ** 2;
      if (squares < least) [nearest, least] = [name, squares];
    }
  }
  return nearest;
}

/// Directions to the fingertips and to the thumb, by metacarpals and first phalanges; null where they lack.
function directions(points: Map<string, ArrayLike<number>>): { distal: Vector3; radial: Vector3 } | null {
  const middle = (bone: string) => {
    const at = points.get(bone), sum = new Vector3();
    if (!at) return null;
    for (let k = 0; k < at.length; k += 3) sum.add(new Vector3(at[k], at[k + 1], at[k + 2]));
    return sum.multiplyScalar(3 / at.length);
  };
  const distal = new Vector3(), row: Vector3[] = [];
  for (const finger of ["index", "middle", "ring", "little"]) {
    const metacarpal = middle(`${finger}_metacarpal`), phalanx = middle(`${finger}_proximal_phalanx`);
    if (metacarpal) row.push(metacarpal);
    if (metacarpal && phalanx) distal.add(phalanx).sub(metacarpal);
  }
  if (row.length < 2 || distal.length() < 1) return null;
  distal.normalize();
  const radial = row[0].clone().sub(row[row.length - 1]);
  return { distal, radial: radial.addScaledVector(distal, -radial.dot(distal)).normalize() };
}

export class BonesView {
  readonly element: HTMLElement;
  private readonly list = el("ul", { class: "marks", "aria-label": say("found.bones") });
  private readonly words = el("p", { class: "status", role: "status" });
  private readonly again: HTMLButtonElement;
  private readonly files: string[]; // of bones
  private names = new BoneNames([], [], () => "");
  private readonly middles = new Map<string, Triple>(); // a point on each bone
  private scene: FoundScene | null = null;
  private carried: string | null = null; // a name on its way to a bone
  private isClosed = false;

  constructor(private readonly api: Api, private readonly job: Job, private readonly revise: (rows: CorrectionRow[]) => void) {
    this.files = job.made.filter((one) => one.startsWith(`${kFolder}bones/`) && one.endsWith(".ply"));
    this.again = el("button", { type: "button", class: "primary", disabled: true, "data-found": "again", onclick: () => this.revise(this.names.rows()) }, say("found.again"));
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
      const bodies: FoundBody[] = [], points = new Map<string, ArrayLike<number>>();
      for (const file of this.files) {
        const geometry = await read(file), name = this.nameOf(file), at = geometry.getAttribute("position");
        geometry.computeBoundingBox();
        points.set(name, at.array);
        this.middles.set(name, [at.getX(0), at.getY(0), at.getZ(0)]);
        bodies.push({ name, geometry, colour: boneNames.includes(name) ? kBone : kUnnamed });
      }
      if (this.job.made.includes(`${kFolder}skin.ply`)) bodies.push({ name: "skin", geometry: await read(`${kFolder}skin.ply`), opacity: 0.18, isTarget: false });
      const index = JSON.parse(new TextDecoder().decode(await this.api.bytes(this.job.key, `made?file=${encodeURIComponent(`${kFolder}scan.json`)}`))) as { side: string };
      if (this.isClosed) return;
      this.names = new BoneNames([...points.keys()], this.job.request.corrections ?? [], (place) => boneNearest(points, place));
      this.scene = new FoundScene(this.element.querySelector<HTMLElement>(".shape")!, { picked: (_mark, bone, place) => this.picked(bone, place), dragged: () => {} });
      this.scene.show(bodies);
      const axes = directions(points);
      if (axes) {
        const palmward = axes.radial.clone().cross(axes.distal).multiplyScalar(index.side === "left" ? -1 : 1);
        this.scene.setSides(palmward.toArray(), axes.distal.toArray(), axes.radial.toArray());
      }
      // A drag of a name ends where the pointer is over a bone.
      const canvas = this.scene.stage.controls.domElement as HTMLElement;
      canvas.addEventListener("dragover", (event) => event.preventDefault());
      canvas.addEventListener("drop", (event) => this.dropped(event as DragEvent));
      this.showList();
      this.light(null);
      this.element.dataset.ready = "reference";
    } catch (error) {
      this.words.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
    }
  }

  private showList(): void {
    fill(this.list, this.files.map((file) => {
      const found = this.nameOf(file), now = this.names.nameOf(found);
      // Carpals have their own names, and what a file said that was sent.
      const others = [...new Set([BoneNames.foundName(found), now])].filter((name) => !boneNames.includes(name));
      const select: HTMLSelectElement = el("select", { "data-bone": found, "aria-label": say("found.bone"), onchange: () => this.rename(found, select.value, this.middles.get(found)!) },
        others.map((name) => el("option", { value: name }, name ? name.replace(/_/g, " ") : say("found.unnamed", { name: found }))), boneNames.map((name) => el("option", { value: name }, namedWords(name))));
      select.value = now;
      const handle = el("span", { class: "handle", draggable: "true", title: say("found.drag_name"), ondragstart: (event) => { this.carried = now; (event as DragEvent).dataTransfer?.setData("text/plain", now); } }, "⠿");
      const row = el("li", { "data-row": found, class: this.names.isRenamed(found) ? "is-changed" : "" }, handle, select);
      row.addEventListener("focusin", () => this.light(found));
      row.addEventListener("pointerenter", () => this.light(found));
      return row;
    }));
    this.again.disabled = this.names.changes === 0;
    this.element.dataset.changes = String(this.names.changes);
    this.words.textContent = say("found.hint_bones", { bones: this.files.length });
  }

  private light(bone: string | null): void {
    for (const file of this.files) {
      const name = this.nameOf(file);
      this.scene?.colour(name, name === bone ? kSelected : this.names.isRenamed(name) ? kRenamed : boneNames.includes(name) ? kBone : kUnnamed);
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

  private rename(found: string, name: string, place: Triple): void {
    this.names.rename(found, name, place, (bone) => this.middles.get(bone)!);
    this.showList();
    this.light(found);
  }
}
