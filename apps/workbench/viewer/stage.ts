// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Canvas, camera and lights of a 3-D view: turning by mouse, touch and keys, looking from a named
// side. Draws when something changes.
import {
  Color, DataTexture, DirectionalLight, HemisphereLight, NearestFilter, Object3D, PerspectiveCamera,
  Mesh, Raycaster, RGBAFormat, Scene, SRGBColorSpace, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

export type Triple = [number, number, number];

const kLeastShare = 0.005; // as in the pictures: less of the scale's end is not shown

export const rgb = (c: Triple) => new Color(`rgb(${c[0]},${c[1]},${c[2]})`);

export function bytes(text: string): ArrayBuffer {
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
  return out.buffer;
}

// Row of 1024 texels: the neutral colour below kLeastShare, then the colour map.
export function scaleTexture(map: string, neutral: Triple): DataTexture {
  const table = new Uint8Array(bytes(map));
  const size = 1024;
  const texels = new Uint8Array(4 * size);
  for (let i = 0; i < size; ++i) {
    const share = i / (size - 1);
    const k = Math.round(255 * share);
    for (let c = 0; c < 3; ++c) {
      texels[4 * i + c] = share <= kLeastShare ? neutral[c] : table[3 * k + c];
    }
    texels[4 * i + 3] = 255;
  }
  const texture = new DataTexture(texels, size, 1, RGBAFormat);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

export class Stage {
  readonly scene = new Scene();
  private readonly renderer: WebGLRenderer;
  private readonly camera = new PerspectiveCamera(30, 1, 1, 5000);
  private readonly controls: OrbitControls;
  private readonly lights = new Object3D();
  private readonly centre = new Vector3();
  private radius = 100;

  // Directions of the hand in the scene: out of the palm, towards the fingertips, to the thumb.
  constructor(section: HTMLElement, private readonly palmward: Triple,
              private readonly distal: Triple, private readonly radial: Triple) {
    const place = section.querySelector<HTMLElement>(".view-canvas")!;
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.setClearColor(0xffffff);
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${place.dataset.label ?? "3-D view"}. Arrow keys turn, plus and minus zoom, 0 resets.`);
    place.replaceChildren(canvas);

    this.scene.add(new HemisphereLight(0xffffff, 0xb8b4ae, 1.5), this.lights);
    const key = new DirectionalLight(0xffffff, 1.6);
    key.position.set(-0.6, 0.8, 1);
    const fill = new DirectionalLight(0xffffff, 0.5);
    fill.position.set(1, -0.3, 0.7);
    this.lights.add(key, fill);

    this.camera.up.set(...distal); // before OrbitControls, which keeps the pole it was made with
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    canvas.addEventListener("keydown", (event) => this.key(event));
    for (const button of section.querySelectorAll<HTMLButtonElement>("[data-look]")) {
      button.addEventListener("click", () => this.look(button.dataset.look!));
    }
    new ResizeObserver(() => this.resize(place)).observe(place);
    this.resize(place);
  }

  // What look() puts in the middle.
  frame(centre: Vector3, radius: number): void {
    this.centre.copy(centre);
    this.radius = Math.max(1, radius);
  }

  look(name: string): void {
    const palm = new Vector3(...this.palmward);
    const distal = new Vector3(...this.distal);
    const radial = new Vector3(...this.radial);
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

  // Tells which triangle of the mesh that `of` gives lies under the pointer; -1: none.
  onPoint(of: () => Mesh | null, tell: (triangle: number) => void): void {
    const canvas = this.renderer.domElement;
    const ray = new Raycaster();
    let latest: PointerEvent | null = null;
    const look = () => {
      const event = latest;
      latest = null;
      if (!event) return;
      const mesh = of();
      const box = canvas.getBoundingClientRect();
      ray.setFromCamera(new Vector2((2 * (event.clientX - box.left)) / box.width - 1,
                                    1 - (2 * (event.clientY - box.top)) / box.height), this.camera);
      tell(mesh ? (ray.intersectObject(mesh, false)[0]?.faceIndex ?? -1) : -1);
    };
    canvas.addEventListener("pointermove", (event) => {
      if (!latest) requestAnimationFrame(look); // at most once a frame
      latest = event;
    });
    canvas.addEventListener("pointerleave", () => tell(-1));
  }

  draw(): void {
    this.lights.quaternion.copy(this.camera.quaternion);
    this.renderer.render(this.scene, this.camera);
  }
}
