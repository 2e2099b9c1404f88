// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The turnable 3-D view of the report. Shows what the report's data say and computes no mechanics.
// Each <section data-palmar-scene="ID"> holds a canvas place, toggles, and a <script
// type="application/json" id="ID"> with the meshes.
import {
  BufferAttribute, BufferGeometry, Color, DataTexture, DirectionalLight, DoubleSide,
  HemisphereLight, Mesh, MeshStandardMaterial, NearestFilter, Object3D, PerspectiveCamera, RGBAFormat,
  Scene, SRGBColorSpace, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

// Arrays are base64 of little-endian numbers.
interface Positions {
  low: [number, number, number]; // corner of the box, mm
  size: [number, number, number]; // its sides, mm
  data: string; // uint16, 3 per vertex: share of the side, 65535 = all of it
}

interface MeshData {
  position: Positions;
  index: string; // 3 per triangle; uint16 up to 65536 vertices, else uint32
  share: string; // uint16, 1 per vertex: pressure, 65535 = the scale's upper end or more
}

interface SceneData {
  table: string; // base64, 256 x RGB
  neutral: [number, number, number];
  skinColour: [number, number, number];
  productColour: [number, number, number];
  palmward: [number, number, number]; // from the palm outwards, product frame
  distal: [number, number, number]; // towards the fingertips
  radial: [number, number, number]; // towards the thumb
  skin: MeshData;
  undeformed: Positions; // positions of the skin before contact
  product: MeshData;
}

const kLeastShare = 0.005; // as in the pictures: less of the scale's end is not shown

function bytes(text: string): ArrayBuffer {
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
  return out.buffer;
}

// Row of 1024 texels: the neutral colour below kLeastShare, then the colour map.
function scaleTexture(data: SceneData): DataTexture {
  const table = new Uint8Array(bytes(data.table));
  const size = 1024;
  const texels = new Uint8Array(4 * size);
  for (let i = 0; i < size; ++i) {
    const share = i / (size - 1);
    const k = Math.round(255 * share);
    for (let c = 0; c < 3; ++c) {
      texels[4 * i + c] = share <= kLeastShare ? data.neutral[c] : table[3 * k + c];
    }
    texels[4 * i + 3] = 255;
  }
  const texture = new DataTexture(texels, size, 1, RGBAFormat);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
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

const rgb = (c: [number, number, number]) => new Color(`rgb(${c[0]},${c[1]},${c[2]})`);

class View {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(30, 1, 1, 5000);
  private readonly controls: OrbitControls;
  private readonly lights = new Object3D();
  private readonly skin: Mesh<BufferGeometry, MeshStandardMaterial>;
  private readonly product: Mesh<BufferGeometry, MeshStandardMaterial>;
  private readonly skinShapes: { deformed: BufferGeometry; undeformed: BufferGeometry };
  private readonly texture: DataTexture;
  private readonly centre = new Vector3();
  private radius = 100;

  constructor(private readonly section: HTMLElement, private readonly data: SceneData) {
    const place = section.querySelector<HTMLElement>(".view-canvas")!;
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.setClearColor(0xffffff);
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${place.dataset.label ?? "3-D view"}. Arrow keys turn, plus and minus zoom, 0 resets.`);
    place.replaceChildren(canvas);

    this.texture = scaleTexture(data);
    this.skinShapes = {
      deformed: geometryOf(data.skin, data.skin.position),
      undeformed: geometryOf(data.skin, data.undeformed),
    };
    const material = () => new MeshStandardMaterial({ roughness: 0.85, metalness: 0, side: DoubleSide });
    this.skin = new Mesh(this.skinShapes.deformed, material());
    this.product = new Mesh(geometryOf(data.product, data.product.position), material());
    this.scene.add(this.skin, this.product, new HemisphereLight(0xffffff, 0xb8b4ae, 1.5), this.lights);
    const key = new DirectionalLight(0xffffff, 1.6);
    key.position.set(-0.6, 0.8, 1);
    const fill = new DirectionalLight(0xffffff, 0.5);
    fill.position.set(1, -0.3, 0.7);
    this.lights.add(key, fill);

    this.skinShapes.deformed.computeBoundingSphere();
    const sphere = this.skinShapes.deformed.boundingSphere!;
    this.centre.copy(sphere.center);
    this.radius = Math.max(1, sphere.radius);
    this.camera.up.set(...data.distal); // before OrbitControls, which keeps the pole it was made with
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    canvas.addEventListener("keydown", (event) => this.key(event));
    for (const input of section.querySelectorAll<HTMLInputElement | HTMLSelectElement>("[data-toggle]")) {
      input.addEventListener("change", () => this.apply());
    }
    for (const button of section.querySelectorAll<HTMLButtonElement>("[data-look]")) {
      button.addEventListener("click", () => this.look(button.dataset.look!));
    }
    new ResizeObserver(() => this.resize(place)).observe(place);
    this.apply();
    this.resize(place);
    this.look("palm");
  }

  private chosen(name: string): boolean {
    return this.section.querySelector<HTMLInputElement>(`[data-toggle="${name}"]`)?.checked ?? false;
  }

  private paint(mesh: Mesh<BufferGeometry, MeshStandardMaterial>, withField: boolean,
                colour: [number, number, number], opacity: number): void {
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
    this.draw();
  }

  private look(name: string): void {
    const palm = new Vector3(...this.data.palmward);
    const distal = new Vector3(...this.data.distal);
    const radial = new Vector3(...this.data.radial);
    const from: Record<string, Vector3> = {
      palm, back: palm.clone().negate(),
      thumb: radial.clone().addScaledVector(palm, 0.3).addScaledVector(distal, 0.25),
      little: radial.clone().negate().addScaledVector(palm, 0.3).addScaledVector(distal, 0.25),
    };
    const direction = (from[name] ?? palm).clone().normalize();
    // A canvas higher than wide sees less to the sides than upwards.
    const distance = 1.15 * this.radius / (Math.sin((this.camera.fov * Math.PI) / 360) * Math.min(1, this.camera.aspect));
    this.controls.target.copy(this.centre);
    this.camera.position.copy(this.centre).addScaledVector(direction, distance);
    this.camera.near = distance / 50;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  private key(event: KeyboardEvent): void {
    const step = 0.12; // rad
    const offset = this.camera.position.clone().sub(this.controls.target);
    const right = new Vector3().crossVectors(this.camera.up, offset).normalize();
    switch (event.key) {
      case "ArrowLeft": offset.applyAxisAngle(this.camera.up, -step); break;
      case "ArrowRight": offset.applyAxisAngle(this.camera.up, step); break;
      case "ArrowUp": offset.applyAxisAngle(right, -step); break;
      case "ArrowDown": offset.applyAxisAngle(right, step); break;
      case "+": case "=": offset.multiplyScalar(0.9); break;
      case "-": offset.multiplyScalar(1 / 0.9); break;
      case "0": this.look("palm"); event.preventDefault(); return;
      default: return;
    }
    event.preventDefault();
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  private resize(place: HTMLElement): void {
    const width = Math.max(1, place.clientWidth);
    const height = Math.max(1, place.clientHeight);
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  private draw(): void {
    this.lights.quaternion.copy(this.camera.quaternion);
    this.renderer.render(this.scene, this.camera);
  }
}

// A browser allows only a few WebGL contexts: views start when they come into sight.
function start(section: HTMLElement): void {
  const place = section.querySelector<HTMLElement>(".view-canvas");
  const source = document.getElementById(section.dataset.palmarScene ?? "");
  if (!place || !source) return;
  try {
    new View(section, JSON.parse(source.textContent ?? "") as SceneData);
    section.classList.add("is-live");
  } catch {
    const note = place.querySelector(".view-fallback");
    if (note) {
      note.textContent =
        "This browser can't show the turnable 3-D view (WebGL is missing or switched off). " +
        "The pictures below show the same result from four sides.";
    }
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
