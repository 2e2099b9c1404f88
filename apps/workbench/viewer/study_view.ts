// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The turnable 3-D view of a study: any hand with any product, and the maps over all hands. Data
// are packed grasp by grasp and unpacked when looked at.
import {
  BufferAttribute, BufferGeometry, Color, DataTexture, DoubleSide, Group, LineBasicMaterial,
  LineSegments, Matrix4, Mesh, MeshStandardMaterial, Vector3,
} from "three";
import { copyPlace, placeWords } from "./place";
import { Stage, Triple, bytes, rgb, scaleTexture } from "./stage";

// Strings are base64 of zlib; see packed_field.h.
interface Places { low: Triple; step: number; data: string }
interface FieldPair { skin: string; product: string } // a byte per vertex: share of the scale's end

// Of a product from CAD. Borders: pairs of ends; no ofTriangle where the mesh shown is a coarser one.
interface ProductFaces { ends: number; borders: Places; ofTriangle: string | null; says: string[] }

interface StudyProduct {
  name: string;
  vertices: number;
  triangles: string;
  places: Places;
  palmward: Triple; distal: Triple; radial: Triple; // of the typical hand, product frame
  typical: number; // index into hands; -1: nobody holds it
  held: number; // hands in the maps
  faces: ProductFaces | null;
  maps: { mean: FieldPair; sd: FieldPair; above: FieldPair };
}

interface StudyGrasp {
  hand: number;
  product: number;
  says: string;
  skin?: Places; // product frame; missing if there is nothing to show
  pressure?: string;
  onProduct?: string;
}

interface StudySceneData {
  table: string; shareTable: string; // base64, 256 x RGB
  neutral: Triple; skinColour: Triple; productColour: Triple;
  vertices: number;
  triangles: string;
  open: Places; // the template's skin in its reference posture
  hands: string[];
  products: StudyProduct[];
  grasps: StudyGrasp[];
}

type MapKind = "mean" | "sd" | "above";

async function inflated(text: string): Promise<Uint8Array> {
  const stream = new Blob([bytes(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Per axis: high bytes of zigzag differences, then low bytes.
async function placesOf(places: Places, count: number): Promise<Float32Array> {
  const packed = await inflated(places.data);
  const xyz = new Float32Array(3 * count);
  for (let axis = 0; axis < 3; ++axis) {
    const high = 2 * axis * count;
    let now = 0;
    for (let i = 0; i < count; ++i) {
      const code = (packed[high + i] << 8) | packed[high + count + i];
      now = (now + ((code >>> 1) ^ -(code & 1))) & 0xffff;
      xyz[3 * i + axis] = places.low[axis] + places.step * now;
    }
  }
  return xyz;
}

async function numbersOf(text: string): Promise<Uint32Array> {
  const differences = new Int32Array((await inflated(text)).buffer);
  const index = new Uint32Array(differences.length);
  let now = 0;
  for (let i = 0; i < index.length; ++i) index[i] = now += differences[i];
  return index;
}

class Surface {
  readonly mesh: Mesh<BufferGeometry, MeshStandardMaterial>;
  borders: LineSegments | null = null; // of its faces
  faceOf: Uint32Array | null = null; // per triangle

  // Of two surfaces in one place the one with `isBehind` is covered.
  constructor(private readonly count: number, index: Uint32Array, isBehind: boolean) {
    const geometry = new BufferGeometry();
    geometry.setIndex(new BufferAttribute(index, 1));
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * count), 3));
    geometry.setAttribute("uv", new BufferAttribute(new Float32Array(2 * count).fill(0.5), 2));
    this.mesh = new Mesh(geometry, new MeshStandardMaterial({
      roughness: 0.85, metalness: 0, side: DoubleSide,
      polygonOffset: isBehind, polygonOffsetFactor: 2, polygonOffsetUnits: 2,
    }));
    this.mesh.frustumCulled = false;
  }

  place(xyz: Float32Array): void {
    const position = this.mesh.geometry.getAttribute("position") as BufferAttribute;
    (position.array as Float32Array).set(xyz);
    position.needsUpdate = true;
    this.mesh.geometry.computeVertexNormals();
    this.mesh.geometry.computeBoundingSphere();
  }

  // Nothing: no field on it.
  field(shares: Uint8Array | null): void {
    const uv = this.mesh.geometry.getAttribute("uv") as BufferAttribute;
    for (let i = 0; i < this.count; ++i) uv.setX(i, shares ? shares[i] / 255 : 0);
    uv.needsUpdate = true;
  }

  paint(texture: DataTexture | null, colour: Triple, opacity: number): void {
    const material = this.mesh.material;
    material.map = texture;
    material.color = texture ? new Color(1, 1, 1) : rgb(colour);
    material.transparent = opacity < 1;
    material.opacity = opacity;
    material.depthWrite = opacity === 1;
    material.needsUpdate = true;
  }
}

export class StudyView {
  private readonly stage: Stage;
  private readonly group = new Group(); // turned so that the palm faces +z, fingertips +y
  private readonly textures: { pressure: DataTexture; share: DataTexture };
  private readonly surfaces = new Map<number, Promise<Surface>>(); // products
  private readonly skin: Promise<Surface>;
  private request = 0;
  private shown: { product: number; surface: Surface } | null = null; // the product in the scene

  constructor(private readonly section: HTMLElement, private readonly data: StudySceneData) {
    // The thumb of a left hand points to -x.
    const first = data.products[0];
    const x = new Vector3(...first.distal).cross(new Vector3(...first.palmward));
    const radial = x.dot(new Vector3(...first.radial)) < 0 ? -1 : 1;
    this.stage = new Stage(section, [0, 0, 1], [0, 1, 0], [radial, 0, 0]);
    this.stage.scene.add(this.group);
    this.textures = {
      pressure: scaleTexture(data.table, data.neutral),
      share: scaleTexture(data.shareTable, data.neutral),
    };
    this.skin = numbersOf(data.triangles).then((index) => new Surface(data.vertices, index, false));
    for (const input of section.querySelectorAll<HTMLInputElement | HTMLSelectElement>("[data-toggle]")) {
      input.addEventListener("change", () => void this.show(false));
    }
    this.stage.sceneTurn = () => this.group.quaternion;
    const shown = () => (this.shown ? [this.shown.surface.mesh] : []);
    this.stage.onPoint(shown, (hits) => this.saysFace(hits[0]?.faceIndex ?? -1, hits[0]?.point),
                       (hits) => { if (hits[0]) copyPlace(this.section, this.productPlace(hits[0].point)); });
    void this.show(true);
  }

  // In the product's frame, mm.
  private productPlace(point: Vector3): Vector3 {
    return point.clone().sub(this.group.position).applyQuaternion(this.group.quaternion.clone().invert());
  }

  private saysFace(triangle: number, point?: Vector3): void {
    const line = this.section.querySelector<HTMLElement>(".view-face");
    const faces = this.shown ? this.data.products[this.shown.product].faces : null;
    const face = triangle >= 0 ? this.shown?.surface.faceOf?.[triangle] : undefined;
    if (!line) return;
    line.dataset.hint ??= line.textContent ?? "";
    const place = point ? ` (${placeWords(this.productPlace(point))}) mm` : "";
    line.textContent = triangle < 0 ? line.dataset.hint
      : face === undefined || !faces ? place.trim()
      : `${faces.says[face].charAt(0).toUpperCase()}${faces.says[face].slice(1)};${place}.`;
  }

  private control<T extends HTMLElement>(name: string): T | null {
    return this.section.querySelector<T>(`[data-toggle="${name}"]`);
  }
  private chosen(name: string): boolean {
    return this.control<HTMLInputElement>(name)?.checked ?? false;
  }

  private product(k: number): Promise<Surface> {
    let surface = this.surfaces.get(k);
    if (!surface) {
      const one = this.data.products[k];
      surface = (async () => {
        const made = new Surface(one.vertices, await numbersOf(one.triangles), true);
        made.place(await placesOf(one.places, one.vertices));
        if (one.faces) {
          const lines = new BufferGeometry();
          lines.setAttribute("position", new BufferAttribute(await placesOf(one.faces.borders, one.faces.ends), 3));
          made.borders = new LineSegments(lines, new LineBasicMaterial({ color: 0x5a646e }));
          if (one.faces.ofTriangle) made.faceOf = await numbersOf(one.faces.ofTriangle);
        }
        return made;
      })();
      this.surfaces.set(k, surface);
    }
    return surface;
  }

  private says(text: string): void {
    const line = this.section.querySelector<HTMLElement>(".view-says");
    if (line) line.textContent = text;
  }

  // Shows what the controls say; `isFirst` also moves the camera.
  private async show(isFirst: boolean): Promise<void> {
    const request = ++this.request;
    const k = Number(this.control<HTMLSelectElement>("which-product")?.value ?? 0);
    const who = this.control<HTMLSelectElement>("which-hand")?.value ?? "mean";
    const product = this.data.products[k];
    const kind = /^(mean|sd|above)$/.test(who) ? (who as MapKind) : null;
    const isOpen = kind !== null && this.chosen("open");
    const hand = kind ? product.typical : Number(who);
    const grasp = this.data.grasps.find((g) => g.product === k && g.hand === hand);

    const skin = await this.skin;
    const surface = await this.product(k);
    const places = isOpen ? this.data.open : grasp?.skin;
    const xyz = places ? await placesOf(places, this.data.vertices) : null;
    const fields = kind ? product.maps[kind] : { skin: grasp?.pressure, product: grasp?.onProduct };
    const onSkin = fields.skin ? await inflated(fields.skin) : null;
    const onProduct = fields.product ? await inflated(fields.product) : null;
    if (request !== this.request) return; // something else was chosen meanwhile

    this.group.clear();
    const texture = kind === "above" ? this.textures.share : this.textures.pressure;
    if (xyz) skin.place(xyz);
    skin.field(onSkin);
    skin.paint(this.chosen("pressure") ? texture : null, this.data.skinColour, 1);
    surface.field(onProduct);
    surface.paint(this.chosen("footprint") ? texture : null, this.data.productColour,
                  this.chosen("see-through") ? 0.3 : 1);
    if (xyz && this.chosen("skin")) this.group.add(skin.mesh);
    this.shown = this.chosen("product") && !isOpen ? { product: k, surface } : null;
    if (this.shown) this.group.add(surface.mesh);
    if (this.shown && surface.borders && this.chosen("faces")) this.group.add(surface.borders);
    // The open hand stands in its own frame, whose axes are the scene's.
    if (isOpen) {
      this.group.quaternion.identity();
    } else {
      const z = new Vector3(...product.palmward);
      const y = new Vector3(...product.distal);
      const x = y.clone().cross(z);
      this.group.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(x, y, z)).invert();
    }
    const sphere = (xyz ? skin : surface).mesh.geometry.boundingSphere!;
    const centre = sphere.center.clone().applyQuaternion(this.group.quaternion);
    this.group.position.copy(centre).negate();
    this.stage.frame(new Vector3(), sphere.radius);

    for (const bar of this.section.querySelectorAll<SVGElement>("[data-bar]")) {
      bar.toggleAttribute("hidden", bar.dataset.bar !== (kind ?? "grasp"));
    }
    if (kind) {
      const words = { mean: "Mean pressure", sd: "Standard deviation of the pressure", above: "Share of hands above the threshold" };
      const where = isOpen ? "on the open template hand" : `on ${this.data.hands[product.typical] ?? "no hand"}`;
      this.says(product.held > 0 ? `${product.name}: ${words[kind]} over ${product.held} hands, shown ${where}.` : `${product.name}: no hand holds it.`);
    } else {
      this.says(`${this.data.hands[hand]}, ${product.name}: ${grasp ? grasp.says : "this grasp wasn't run"}.`.replace(/\.\.$/, "."));
    }
    this.section.dataset.shown = `${k}/${who}`;
    if (isFirst) this.stage.look("palm");
    this.stage.draw();
  }
}
