// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A redesign to look at: the product as it was, the shape that was made of it in colours of how far its
// surface moved, both over each other, and where hands touch.
import { Box3, BufferAttribute, BufferGeometry, Color, DoubleSide, Mesh, MeshStandardMaterial, Sphere, Vector3 } from "three";
import { PLYLoader } from "three/examples/jsm/loaders/PLYLoader.js";
import { Stage, rgb, scaleTexture } from "../viewer/stage";
import { Api, Job } from "./api";
import { colourBar } from "./colour_bar";
import { el, fill } from "./dom";
import { decodeFrame, MeshFrame } from "./live_frame";
import { decimal, say, TextKey } from "./say";
import { tableText } from "./scene";

type Shown = "touched" | "before" | "both" | "after";
type Body = Mesh<BufferGeometry, MeshStandardMaterial>;

const kSmallestScale = 0.2; // mm

function bodyOf(frame: MeshFrame): Body {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(frame.positions, 3));
  geometry.setIndex(new BufferAttribute(frame.triangles, 1));
  geometry.computeVertexNormals();
  return new Mesh(geometry, new MeshStandardMaterial({ roughness: 0.85, metalness: 0, side: DoubleSide }));
}

export class ShapeView {
  readonly element: HTMLElement;
  private readonly choices = el("span", { class: "group", role: "group", "aria-label": say("shape.shown") });
  private readonly bar = el("div", { class: "view-bar" });
  private readonly words = el("p", { class: "status", role: "status" });
  private readonly legend = el("p", { class: "point legend" });
  private readonly bodies: Partial<Record<"before" | "after" | "touched", Body>> = {};
  private stage: Stage | null = null;
  private isClosed = false;
  private most = 0; // mm

  /// `of`: the preview, or what came of the redesign.
  constructor(private readonly api: Api, private readonly job: Job, private readonly of: "preview" | "result") {
    const look = (name: "palm" | "back" | "thumb" | "little", key: TextKey) => el("button", { type: "button", "data-look": name }, say(key));
    this.element = el("section", { class: "shape", "aria-label": say("shape.view") },
      el("div", { class: "tools" }, this.choices,
        el("span", { class: "group", role: "group", "aria-label": say("bench.look") }, el("span", { class: "soft" }, say("bench.look")),
          look("palm", "shape.front"), look("back", "shape.back"), look("thumb", "shape.right"), look("little", "shape.left")),
        el("label", {}, say("bench.cut"), el("input", { type: "range", "data-cut": true, min: 0, max: 100, value: 100 })),
        el("button", { type: "button", "data-save": "palmar-shape" }, say("bench.picture"))),
      el("div", { class: "view" }, el("div", { class: "view-canvas", "data-label": say("shape.view") }), this.bar), this.words, this.legend);
    this.words.textContent = say("shape.loading");
  }

  close(): void {
    this.isClosed = true;
    this.stage?.dispose();
  }

  /// Once it is in the page.
  async load(): Promise<void> {
    const { api, job, of } = this;
    try {
      const region = of === "preview" ? "preview/region.ply" : "region.ply";
      const hasRegion = of === "preview" ? job.made.includes(region) : job.files.includes(region);
      const [before, after, touched] = await Promise.all([
        api.bytes(job.key, `shape?of=${of}&what=before`).then((bytes) => decodeFrame(bytes) as MeshFrame),
        api.bytes(job.key, `shape?of=${of}&what=after`).then((bytes) => decodeFrame(bytes) as MeshFrame, () => null),
        hasRegion ? api.bytes(job.key, of === "preview" ? `made?file=${encodeURIComponent(region)}` : `files/${region}`) : null,
      ]);
      const { colours } = await api.state();
      if (this.isClosed) return;
      this.bodies.before = bodyOf(before);
      this.bodies.before.material.color = rgb(colours.product);
      if (after) {
        this.most = after.pressure.reduce((most, one) => Math.max(most, one), 0);
        const body = bodyOf(after), upper = Math.max(this.most, kSmallestScale);
        const uv = new Float32Array(2 * after.pressure.length).fill(0.5);
        after.pressure.forEach((one, i) => { uv[2 * i] = Math.min(1, one / upper); });
        body.geometry.setAttribute("uv", new BufferAttribute(uv, 2));
        body.material.map = scaleTexture(tableText(colours), colours.product);
        this.bodies.after = body;
        this.bar.innerHTML = colourBar(colours, upper, { title: say("shape.moved"), unit: "mm", none: say("shape.unmoved"), noneColour: colours.product });
      }
      if (touched) {
        const geometry = new PLYLoader().parse(touched);
        geometry.computeVertexNormals();
        this.bodies.touched = new Mesh(geometry, new MeshStandardMaterial({ roughness: 0.85, metalness: 0, side: DoubleSide, vertexColors: geometry.hasAttribute("color") }));
      }
      this.build();
    } catch (error) {
      this.words.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
    }
  }

  private build(): void {
    const stage = new Stage(this.element, [1, 0, 0], [0, 0, 1], [0, 1, 0]);
    this.stage = stage;
    const box = new Box3();
    for (const body of Object.values(this.bodies)) {
      stage.scene.add(body);
      box.union(new Box3().setFromObject(body));
    }
    const sphere = box.getBoundingSphere(new Sphere());
    stage.frame(sphere.center.clone() as Vector3, sphere.radius);
    const all: Shown[] = ["touched", "before", "both", "after"];
    const possible = all.filter((one) => (one === "both" ? this.bodies.after : this.bodies[one]));
    fill(this.choices, possible.map((one) => el("button", { type: "button", "data-shape": one, "aria-pressed": "false", onclick: () => this.show(one) }, say(`shape.${one}`))));
    this.show(this.bodies.after ? "after" : possible[0]);
    stage.look("thumb");
    this.element.dataset.ready = "true";
    this.element.dataset.most = this.most.toFixed(3);
  }

  private show(what: Shown): void {
    const { before, after, touched } = this.bodies;
    for (const button of this.choices.querySelectorAll<HTMLElement>("button")) button.setAttribute("aria-pressed", String(button.dataset.shape === what));
    if (touched) touched.visible = what === "touched";
    if (after) after.visible = what === "after" || what === "both";
    if (before) {
      before.visible = what === "before" || what === "both";
      before.material.transparent = what === "both";
      before.material.opacity = what === "both" ? 0.3 : 1;
      before.material.depthWrite = what !== "both";
      // Where both lie on each other, the new one is seen.
      before.material.polygonOffset = what === "both";
      before.material.polygonOffsetFactor = before.material.polygonOffsetUnits = 2;
      before.material.color = what === "both" ? new Color(0x3f6fb5) : before.material.color;
      before.material.needsUpdate = true;
    }
    this.bar.hidden = what === "touched" || what === "before";
    const hands = this.of === "preview" ? say("shape.preview", { what: say(`redesign.${this.job.request.verb as "press"}`) }) : "";
    this.words.textContent = this.bodies.after ? say("shape.most", { most: decimal(this.most, 1) }) + (hands ? ` ${hands}` : "") : say("shape.only_region");
    fill(this.legend, what === "touched" ? [el("span", { class: "key fingers" }), say("shape.fingers"), el("span", { class: "key thumb" }), say("shape.thumb"), el("span", { class: "key palm" }), say("shape.palm")] : say(`shape.says.${what}`));
    this.element.dataset.shown = what;
    this.stage?.draw();
  }
}
