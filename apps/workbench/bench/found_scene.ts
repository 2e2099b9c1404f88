// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What was found on a person's scan, in 3-D: surfaces, and marks on them that can be pointed at, dragged
// and put where they belong.
import { Box3, BufferGeometry, Color, DoubleSide, Intersection, Mesh, MeshBasicMaterial, MeshStandardMaterial, Object3D, Raycaster, Sphere, SphereGeometry, Vector2, Vector3 } from "three";
import { Stage, Triple } from "../viewer/stage";

const kGrasp = 10; // CSS pixels round a mark
const kBuried = 4; // mm; marks lie on the surface, and a little under it where it is rough

export interface FoundBody {
  name: string;
  geometry: BufferGeometry;
  colour?: number; // of a surface without colours of its own
  opacity?: number;
  isTarget?: boolean; // marks can be put there; it can be picked
}

export interface FoundMark {
  id: string;
  place: Triple;
  colour: number;
  radius: number; // mm
}

export interface FoundEvents {
  picked(mark: string | null, body: string | null, place: Triple | null): void;
  /// While a mark is dragged over a target, and once more when it is let go.
  dragged(mark: string, place: Triple, isOver: boolean): void;
}

export class FoundScene {
  readonly stage: Stage;
  private readonly bodies: Mesh<BufferGeometry, MeshStandardMaterial>[] = [];
  private readonly marks = new Object3D();
  private readonly ray = new Raycaster();
  private held: Mesh | null = null;
  private from: PointerEvent | null = null;
  private selected: string | null = null;

  constructor(section: HTMLElement, private readonly events: FoundEvents) {
    this.stage = new Stage(section, [0, 0, -1], [0, 1, 0], [-1, 0, 0]);
    this.stage.scene.add(this.marks);
    const canvas = this.stage.controls.domElement as HTMLCanvasElement;
    // Before the controls, which turn the view.
    canvas.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.drag(event), { capture: true });
    canvas.addEventListener("pointerup", (event) => this.letGo(event), { capture: true });
  }

  show(bodies: FoundBody[]): void {
    for (const one of this.bodies.splice(0)) {
      this.stage.scene.remove(one);
      one.geometry.dispose();
      one.material.dispose();
    }
    const box = new Box3();
    for (const one of bodies) {
      const hasColours = one.geometry.hasAttribute("color");
      const material = new MeshStandardMaterial({ roughness: 0.9, metalness: 0, side: DoubleSide, vertexColors: hasColours });
      if (!hasColours) material.color = new Color(one.colour ?? 0xd8c3b4);
      if (one.opacity !== undefined) Object.assign(material, { transparent: true, opacity: one.opacity, depthWrite: false });
      const mesh = new Mesh(one.geometry, material);
      mesh.name = one.name;
      mesh.userData.isTarget = one.isTarget ?? true;
      this.bodies.push(mesh);
      this.stage.scene.add(mesh);
      box.union(new Box3().setFromObject(mesh));
    }
    const sphere = box.getBoundingSphere(new Sphere());
    this.stage.frame(sphere.center, sphere.radius);
    this.stage.look("back");
    this.stage.use(true);
  }

  /// Directions of what is shown: out of the palm, to the fingertips, to the thumb.
  setSides(palmward: Triple, distal: Triple, radial: Triple): void {
    this.stage.setSides(palmward, distal, radial);
    this.stage.camera.up.set(...distal);
    this.stage.look("back");
  }

  colour(body: string, colour: number): void {
    for (const one of this.bodies) if (one.name === body) one.material.color = new Color(colour);
    this.stage.draw();
  }

  setMarks(marks: FoundMark[]): void {
    for (const one of [...this.marks.children] as Mesh<SphereGeometry, MeshBasicMaterial>[]) {
      this.marks.remove(one);
      one.geometry.dispose();
      one.material.dispose();
    }
    for (const mark of marks) {
      const ball = new Mesh(new SphereGeometry(mark.radius, 16, 12), new MeshBasicMaterial({ color: mark.colour }));
      ball.position.set(...mark.place);
      ball.name = mark.id;
      this.marks.add(ball);
    }
    this.select(this.selected);
  }

  select(mark: string | null): void {
    this.selected = mark;
    for (const one of this.marks.children) one.scale.setScalar(one.name === mark ? 1.9 : 1);
    this.stage.draw();
  }

  /// Where a mark is seen, CSS pixels in the window; for tests and labels.
  seenAt(place: Triple): { x: number; y: number } {
    const canvas = this.stage.controls.domElement as HTMLCanvasElement;
    const box = canvas.getBoundingClientRect();
    const at = new Vector3(...place).project(this.stage.camera);
    return { x: box.left + ((at.x + 1) / 2) * box.width, y: box.top + ((1 - at.y) / 2) * box.height };
  }

  private hits(event: Pick<PointerEvent, "clientX" | "clientY">, of: Object3D[]): Intersection[] {
    const box = (this.stage.controls.domElement as HTMLElement).getBoundingClientRect();
    this.ray.setFromCamera(new Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height), this.stage.camera);
    return this.ray.intersectObjects(of, false);
  }
  private targets(): Object3D[] { return this.bodies.filter((one) => one.userData.isTarget); }

  bodyAt(x: number, y: number): { name: string; place: Triple } | null {
    const hit = this.hits({ clientX: x, clientY: y }, this.targets())[0];
    return hit ? { name: hit.object.name, place: hit.point.toArray() as Triple } : null;
  }

  // The mark that is nearest to the pointer; one behind the surface can't be taken.
  private markAt(event: PointerEvent): Mesh | null {
    let best: Mesh | null = null, least = kGrasp;
    for (const one of this.marks.children) {
      const at = this.seenAt(one.position.toArray() as Triple);
      const away = Math.hypot(at.x - event.clientX, at.y - event.clientY);
      if (away < least) [best, least] = [one as Mesh, away];
    }
    if (!best) return null;
    const at = this.seenAt(best.position.toArray() as Triple);
    const before = this.hits({ clientX: at.x, clientY: at.y }, this.targets())[0];
    return before && before.distance < this.stage.camera.position.distanceTo(best.position) - kBuried ? null : best;
  }

  private press(event: PointerEvent): void {
    this.from = event;
    this.held = this.markAt(event);
    if (!this.held) return;
    this.select(this.held.name);
    event.stopImmediatePropagation();
    (event.target as Element).setPointerCapture(event.pointerId);
  }

  private isMoved(event: PointerEvent): boolean {
    return this.from !== null && Math.hypot(event.clientX - this.from.clientX, event.clientY - this.from.clientY) >= 4;
  }

  private drag(event: PointerEvent): void {
    if (!this.held || !this.isMoved(event)) return;
    event.stopImmediatePropagation();
    const hit = this.hits(event, this.targets())[0];
    if (!hit) return;
    this.held.position.copy(hit.point);
    this.stage.draw();
    this.events.dragged(this.held.name, hit.point.toArray() as Triple, false);
  }

  private letGo(event: PointerEvent): void {
    const held = this.held;
    this.held = null;
    if (held) {
      event.stopImmediatePropagation();
      if (this.isMoved(event)) this.events.dragged(held.name, held.position.toArray() as Triple, true);
      else this.events.picked(held.name, null, held.position.toArray() as Triple);
    } else if (this.from && !this.isMoved(event)) {
      const hit = this.hits(event, this.targets())[0];
      this.events.picked(null, hit ? hit.object.name : null, hit ? (hit.point.toArray() as Triple) : null);
    }
    this.from = null;
  }
}
