// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The turnable 3-D view of the report. Shows what the report's data say and computes no mechanics.
// Each <section data-palmar-scene="ID"> holds a canvas place, toggles, and a <script
// type="application/json" id="ID"> with the meshes; one with two IDs shows both side by side.
import {
  BufferAttribute, BufferGeometry, Color, DataTexture, DoubleSide, Intersection, Mesh, MeshStandardMaterial,
} from "three";
import { copyPlace, placeWords } from "./place";
import { Stage, Triple, bytes, rgb, scaleTexture } from "./stage";
import { StudyView } from "./study_view";

// Arrays are base64 of little-endian numbers.
interface Positions {
  low: Triple; // corner of the box, mm
  size: Triple; // its sides, mm
  data: string; // uint16, 3 per vertex: share of the side, 65535 = all of it
}

interface MeshData {
  position: Positions;
  index: string; // 3 per triangle; uint16 up to 65536 vertices, else uint32
  share: string; // uint16, 1 per vertex: pressure, 65535 = the scale's upper end or more
}

interface SceneData {
  table: string; // base64, 256 x RGB
  neutral: Triple;
  skinColour: Triple;
  productColour: Triple;
  palmward: Triple; // from the palm outwards, product frame
  distal: Triple; // towards the fingertips
  radial: Triple; // towards the thumb
  skin: MeshData;
  undeformed: Positions; // positions of the skin before contact
  product: MeshData;
  upper: number; // of the pressure scale, MPa
  regions: { names: string[]; ofVertex: string }; // of the skin; uint8
  faces: { names: string[]; ofTriangle: string } | null; // of the product; uint16
}

function geometryOf(mesh: MeshData, position: Positions): BufferGeometry {
  const shares = new Uint16Array(bytes(position.data));
  const xyz = new Float32Array(shares.length);
  for (let i = 0; i < xyz.length; ++i) xyz[i] = position.low[i % 3] + (position.size[i % 3] * shares[i]) / 65535;
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(xyz, 3));
  const index = bytes(mesh.index);
  geometry.setIndex(new BufferAttribute(xyz.length <= 3 * 65536 ? new Uint16Array(index) : new Uint32Array(index), 1));
  const pressure = new Uint16Array(bytes(mesh.share));
  const uv = new Float32Array(2 * pressure.length);
  for (let i = 0; i < pressure.length; ++i) {
    uv[2 * i] = pressure[i] / 65535;
    uv[2 * i + 1] = 0.5;
  }
  geometry.setAttribute("uv", new BufferAttribute(uv, 2));
  geometry.computeVertexNormals();
  return geometry;
}

class View {
  readonly stage: Stage;
  private readonly regionOf: Uint8Array;
  private readonly faceOf: Uint16Array | null;
  private readonly skin: Mesh<BufferGeometry, MeshStandardMaterial>;
  private readonly product: Mesh<BufferGeometry, MeshStandardMaterial>;
  private readonly skinShapes: { deformed: BufferGeometry; undeformed: BufferGeometry };
  private readonly texture: DataTexture;

  constructor(private readonly section: HTMLElement, place: HTMLElement, private readonly data: SceneData) {
    this.stage = new Stage(section, data.palmward, data.distal, data.radial, place);
    this.regionOf = new Uint8Array(bytes(data.regions.ofVertex));
    this.faceOf = data.faces ? new Uint16Array(bytes(data.faces.ofTriangle)) : null;
    this.texture = scaleTexture(data.table, data.neutral);
    this.skinShapes = {
      deformed: geometryOf(data.skin, data.skin.position),
      undeformed: geometryOf(data.skin, data.undeformed),
    };
    const material = () => new MeshStandardMaterial({ roughness: 0.85, metalness: 0, side: DoubleSide });
    this.skin = new Mesh(this.skinShapes.deformed, material());
    this.product = new Mesh(geometryOf(data.product, data.product.position), material());
    this.stage.scene.add(this.skin, this.product);
    this.skinShapes.deformed.computeBoundingSphere();
    const sphere = this.skinShapes.deformed.boundingSphere!;
    this.stage.frame(sphere.center, sphere.radius);
    for (const input of section.querySelectorAll<HTMLInputElement | HTMLSelectElement>("[data-toggle]")) {
      input.addEventListener("change", () => this.apply());
    }
    this.apply();
    this.stage.look("palm");
    this.stage.onPoint(() => [this.skin, this.product].filter((mesh) => mesh.visible), (hits) => this.says(hits),
                       (hits) => { if (hits[0]) copyPlace(section, (this.of(hits, this.product) ?? hits[0]).point); });
  }

  private of(hits: Intersection[], mesh: Mesh): Intersection | undefined {
    return hits.find((hit) => hit.object === mesh);
  }

  // What is pointed at: region and pressure of the skin, face and place of the product.
  private says(hits: Intersection[]): void {
    const line = this.section.querySelector<HTMLElement>(".view-point");
    if (!line) return;
    line.dataset.hint ??= line.textContent ?? "";
    const product = this.of(hits, this.product);
    const isOpaque = !this.chosen("see-through");
    const skin = product && isOpaque && hits[0] === product ? undefined : this.of(hits, this.skin);
    const parts: string[] = [];
    const pressure = (hit: Intersection) => `${((hit.uv?.x ?? 0) * this.data.upper).toPrecision(2)} MPa`;
    if (skin?.face) parts.push(`${this.data.regions.names[this.regionOf[skin.face.a]]}: ${pressure(skin)}`);
    if (product) {
      const face = this.faceOf && product.faceIndex !== undefined && product.faceIndex !== null
        ? this.data.faces?.names[this.faceOf[product.faceIndex]] : undefined;
      parts.push(`${face ? `${face} ` : ""}(${placeWords(product.point)}) mm`);
    } else if (skin) {
      parts.push(`(${placeWords(skin.point)}) mm`);
    }
    line.textContent = parts.length > 0 ? parts.join("; ") : line.dataset.hint;
  }

  private chosen(name: string): boolean {
    return this.section.querySelector<HTMLInputElement>(`[data-toggle="${name}"]`)?.checked ?? false;
  }

  private paint(mesh: Mesh<BufferGeometry, MeshStandardMaterial>, withField: boolean,
                colour: Triple, opacity: number): void {
    mesh.material.map = withField ? this.texture : null;
    mesh.material.color = withField ? new Color(1, 1, 1) : rgb(colour);
    mesh.material.transparent = opacity < 1;
    mesh.material.opacity = opacity;
    mesh.material.depthWrite = opacity === 1;
    mesh.material.needsUpdate = true;
  }

  private apply(): void {
    this.skin.visible = this.chosen("skin");
    this.skin.geometry = this.chosen("undeformed") ? this.skinShapes.undeformed : this.skinShapes.deformed;
    this.paint(this.skin, this.chosen("pressure"), this.data.skinColour, 1);
    this.product.visible = this.chosen("product");
    this.paint(this.product, this.chosen("footprint"), this.data.productColour,
               this.chosen("see-through") ? 0.3 : 1);
    this.stage.draw();
  }
}

function sceneNamed(id: string): unknown {
  const source = document.getElementById(id);
  return source ? JSON.parse(source.textContent ?? "") : null;
}

// A browser allows only a few WebGL contexts: views start when they come into sight.
function start(section: HTMLElement): void {
  const places = section.querySelectorAll<HTMLElement>(".view-canvas");
  const ids = (section.dataset.palmarScene ?? "").split(" ");
  if (places.length !== ids.length) return;
  try {
    const data = ids.map(sceneNamed);
    if (section.dataset.palmarKind === "study") {
      new StudyView(section, data[0] as ConstructorParameters<typeof StudyView>[1]);
    } else {
      const views = data.map((one, i) => new View(section, places[i], one as SceneData));
      if (views.length === 2) {
        views[0].stage.leads(views[1].stage);
        views[1].stage.leads(views[0].stage);
        views[0].stage.look("palm");
      }
    }
    section.classList.add("is-live");
  } catch {
    // The words in its place stay.
  }
}

const watcher = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    if (!entry.isIntersecting) continue;
    watcher.unobserve(entry.target);
    start(entry.target as HTMLElement);
  }
}, { rootMargin: "200px" });
for (const section of document.querySelectorAll<HTMLElement>("[data-palmar-scene]")) watcher.observe(section);
