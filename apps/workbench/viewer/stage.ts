// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Canvas, camera and lights of a 3-D view: turning by mouse, touch and keys, looking from a named
// side, axes and a scale bar, a plane that cuts, the picture as a file. Draws when something changes.
// The wheel and one finger scroll the page until the view is clicked.
import {
  Color, DataTexture, DirectionalLight, HemisphereLight, Intersection, NearestFilter, Object3D,
  PerspectiveCamera, Mesh, Plane, Quaternion, Raycaster, RGBAFormat, Scene, SRGBColorSpace, Vector2, Vector3,
  WebGLRenderer,
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
  readonly camera = new PerspectiveCamera(30, 1, 1, 5000);
  readonly controls: OrbitControls;
  private readonly lights = new Object3D();
  private readonly centre = new Vector3();
  private radius = 100;
  private readonly overlay: SVGSVGElement;
  private readonly cut = new Plane();
  private readonly sizes: ResizeObserver;
  private follower: Stage | null = null;
  private isFollowing = false;

  // Directions of the hand in the scene: out of the palm, towards the fingertips, to the thumb.
  constructor(private readonly section: HTMLElement, private palmward: Triple,
              private distal: Triple, private radial: Triple,
              private readonly place = section.querySelector<HTMLElement>(".view-canvas")!) {
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.setClearColor(0xffffff);
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${place.dataset.label ?? "3-D view"}. Arrow keys turn, plus and minus zoom, 0 resets.`);
    this.overlay = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    this.overlay.setAttribute("class", "view-overlay");
    this.overlay.setAttribute("aria-hidden", "true");
    place.replaceChildren(canvas, this.overlay);
    // Before OrbitControls, whose own listeners then see the same press.
    canvas.addEventListener("pointerdown", (event) => {
      if (event.pointerType === "mouse") this.use(true);
    });
    canvas.addEventListener("click", () => this.use(true));
    canvas.addEventListener("focus", () => this.use(true));
    document.addEventListener("pointerdown", this.elsewhere);

    this.scene.add(new HemisphereLight(0xffffff, 0xb8b4ae, 1.5), this.lights);
    const key = new DirectionalLight(0xffffff, 1.6);
    key.position.set(-0.6, 0.8, 1);
    const fill = new DirectionalLight(0xffffff, 0.5);
    fill.position.set(1, -0.3, 0.7);
    this.lights.add(key, fill);

    this.camera.up.set(...distal); // before OrbitControls, which keeps the pole it was made with
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.changed());
    this.use(false);
    canvas.addEventListener("keydown", (event) => this.key(event));
    for (const button of section.querySelectorAll<HTMLButtonElement>("[data-look]")) {
      button.addEventListener("click", () => this.look(button.dataset.look!));
    }
    for (const input of section.querySelectorAll<HTMLInputElement>("[data-cut]")) {
      input.addEventListener("input", () => this.cutAt(Number(input.value) / Number(input.max)));
    }
    for (const button of section.querySelectorAll<HTMLButtonElement>("[data-save]")) {
      button.addEventListener("click", () => void this.save(button.dataset.save || "view"));
    }
    this.sizes = new ResizeObserver(() => this.resize(place));
    this.sizes.observe(place);
    this.resize(place);
  }

  private readonly elsewhere = (event: Event): void => {
    if (!this.section.contains(event.target as Node)) this.use(false);
  };

  // What outlives the page's element otherwise: listeners, and the graphics memory of the canvas.
  dispose(): void {
    document.removeEventListener("pointerdown", this.elsewhere);
    this.sizes.disconnect();
    this.controls.dispose();
    this.scene.traverse((one) => {
      if (!(one instanceof Mesh)) return;
      one.geometry.dispose();
      for (const material of Array.isArray(one.material) ? one.material : [one.material]) material.dispose();
    });
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  // Whether wheel and fingers are the view's or the page's.
  use(isUsed: boolean): void {
    this.controls.enabled = isUsed;
    this.renderer.domElement.style.touchAction = isUsed ? "none" : "pan-y";
    this.section.classList.toggle("is-used", isUsed);
  }

  // Another hand, whose palm, fingertips and thumb point elsewhere.
  setSides(palmward: Triple, distal: Triple, radial: Triple): void {
    this.palmward = palmward;
    this.distal = distal;
    this.radial = radial;
  }

  // From now on `other` looks from the same side of its hand and from as far.
  leads(other: Stage): void {
    this.follower = other;
  }

  private changed(): void {
    this.draw();
    const other = this.follower;
    if (!other || this.isFollowing) return;
    const offset = this.camera.position.clone().sub(this.controls.target).divideScalar(this.radius);
    const moved = this.controls.target.clone().sub(this.centre).divideScalar(this.radius);
    const own = [this.palmward, this.distal, this.radial].map((axis) => new Vector3(...axis));
    const theirs = [other.palmward, other.distal, other.radial].map((axis) => new Vector3(...axis));
    const turned = (v: Vector3) => {
      const sum = new Vector3();
      for (let k = 0; k < 3; ++k) sum.addScaledVector(theirs[k], v.dot(own[k]));
      return sum.multiplyScalar(other.radius);
    };
    other.isFollowing = true;
    other.controls.target.copy(other.centre).add(turned(moved));
    other.camera.position.copy(other.controls.target).add(turned(offset));
    other.camera.near = this.camera.near;
    other.camera.far = this.camera.far;
    other.camera.updateProjectionMatrix();
    const isEnabled = other.controls.enabled;
    other.controls.enabled = true;
    other.controls.update();
    other.controls.enabled = isEnabled;
    other.draw();
    other.isFollowing = false;
  }

  // Cuts away what is in front of a plane across the palm's direction; 1: nothing.
  private cutAt(share: number): void {
    const normal = new Vector3(...this.palmward).negate();
    const depth = this.centre.dot(new Vector3(...this.palmward)) + (2 * share - 1) * this.radius;
    this.cut.set(normal, depth);
    this.renderer.clippingPlanes = share < 1 ? [this.cut] : [];
    this.draw();
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
    this.changed();
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
      case "Escape": this.use(false); return;
      default: return;
    }
    event.preventDefault();
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.changed();
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

  // Tells what lies under the pointer, nearest first, and what was clicked (not dragged).
  onPoint(of: () => Mesh[], tell: (hits: Intersection[]) => void, click?: (hits: Intersection[]) => void): void {
    const canvas = this.renderer.domElement;
    const ray = new Raycaster();
    let latest: PointerEvent | null = null;
    const hits = (event: PointerEvent): Intersection[] => {
      const box = canvas.getBoundingClientRect();
      ray.setFromCamera(new Vector2((2 * (event.clientX - box.left)) / box.width - 1,
                                    1 - (2 * (event.clientY - box.top)) / box.height), this.camera);
      const isCut = (hit: Intersection) =>
        this.renderer.clippingPlanes.some((plane) => (plane as Plane).distanceToPoint(hit.point) < 0);
      return ray.intersectObjects(of(), false).filter((hit) => !isCut(hit));
    };
    const look = () => {
      const event = latest;
      latest = null;
      if (event) tell(hits(event));
    };
    canvas.addEventListener("pointermove", (event) => {
      if (!latest) requestAnimationFrame(look); // at most once a frame
      latest = event;
    });
    canvas.addEventListener("pointerleave", () => tell([]));
    if (!click) return;
    let pressed: PointerEvent | null = null;
    canvas.addEventListener("pointerdown", (event) => { pressed = event; });
    canvas.addEventListener("pointerup", (event) => {
      if (pressed && Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY) < 4) click(hits(event));
      pressed = null;
    });
  }

  // Axes of the product and a length to compare with.
  private drawOverlay(): void {
    const width = this.place.clientWidth, height = this.place.clientHeight;
    const distance = this.camera.position.distanceTo(this.controls.target);
    if (distance === 0) return; // nothing has been looked at yet
    const perMm = height / (2 * distance * Math.tan((this.camera.fov * Math.PI) / 360));
    let length = 1;
    for (const next of [2, 5, 10, 20, 50, 100, 200, 500]) if (next * perMm <= 0.3 * width) length = next;
    const right = width - 14, y = height - 14, left = right - length * perMm;
    const turn = this.camera.quaternion.clone().invert();
    const axes = [["x", "#b3202f", new Vector3(1, 0, 0)], ["y", "#1d7a4a", new Vector3(0, 1, 0)], ["z", "#0072b2", new Vector3(0, 0, 1)]] as const;
    const arrows = axes.map(([name, colour, axis]) => {
      const v = axis.clone().applyQuaternion(this.sceneTurn()).applyQuaternion(turn).multiplyScalar(26);
      return `<path d="M38 ${height - 38}l${v.x.toFixed(1)} ${(-v.y).toFixed(1)}" stroke="${colour}" stroke-width="2"/><text x="${(34 + 1.3 * v.x).toFixed(1)}" y="${(height - 34 - 1.3 * v.y).toFixed(1)}" fill="${colour}">${name}</text>`;
    });
    this.overlay.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.overlay.innerHTML = `${arrows.join("")}<path d="M${left.toFixed(1)} ${y}H${right}m0 -5v10M${left.toFixed(1)} ${y - 5}v10" stroke="#1d2329" fill="none"/><text x="${((left + right) / 2).toFixed(1)}" y="${y - 7}" text-anchor="middle">${length} mm</text>`;
  }

  // How the product's frame stands in the scene; a view that turns it says so.
  sceneTurn: () => Quaternion = () => new Quaternion();

  // The view with its colour bar as a PNG.
  private async save(name: string): Promise<void> {
    this.draw();
    const view = this.renderer.domElement;
    const ratio = view.width / Math.max(1, this.place.clientWidth);
    const bar = this.section.querySelector<SVGSVGElement>(".view-bar svg:not([hidden])");
    const picture = document.createElement("canvas");
    picture.width = view.width + (bar ? 130 * ratio : 0);
    picture.height = view.height;
    const pen = picture.getContext("2d");
    if (!pen) return;
    pen.fillStyle = "#fff";
    pen.fillRect(0, 0, picture.width, picture.height);
    pen.drawImage(view, 0, 0);
    const put = async (svg: SVGSVGElement, x: number, y: number, w: number, h: number) => {
      const copy = svg.cloneNode(true) as SVGSVGElement;
      copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
      copy.setAttribute("width", String(w));
      copy.setAttribute("height", String(h));
      copy.setAttribute("font-family", "sans-serif");
      const image = new Image();
      image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
      await image.decode();
      pen.drawImage(image, x, y, w, h);
    };
    await put(this.overlay, 0, 0, view.width, view.height);
    if (bar) await put(bar, view.width + 8 * ratio, 10 * ratio, 112 * ratio, Math.min(480 * ratio, view.height - 20 * ratio));
    const link = document.createElement("a");
    link.download = `${name}.png`;
    link.href = picture.toDataURL("image/png");
    link.click();
  }

  draw(): void {
    this.lights.quaternion.copy(this.camera.quaternion);
    this.renderer.render(this.scene, this.camera);
    this.drawOverlay();
  }
}
