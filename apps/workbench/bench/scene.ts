// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Hand and product in 3-D, in the hand's frame: the palm stands still, the product moves by a gizmo.
// Shows what the server sends and computes no mechanics.
import {
  BufferAttribute, BufferGeometry, Color, DataTexture, DirectionalLight, DoubleSide, Euler, Group, HemisphereLight,
  Intersection, Matrix4, Mesh, MeshStandardMaterial, PerspectiveCamera, Quaternion, Scene, Vector3, WebGLRenderer,
} from "three";
import { TransformControls } from "three/examples/jsm/controls/TransformControls.js";
import { rgb, scaleTexture, Stage, Triple } from "../viewer/stage";
import { measured } from "./live_channel";
import { FieldFrame, HandFrame, MeshFrame, Place } from "./live_frame";

export interface Colours {
  table: Triple[];
  neutral: Triple;
  skin: Triple;
  product: Triple;
}

/// The colour table as scaleTexture() takes it.
export function tableText(colours: Colours): string {
  let bytes = "";
  for (const colour of colours.table) bytes += String.fromCharCode(...colour);
  return btoa(bytes);
}

export interface Pointed {
  region: number | null; // null: the product
  pressure: number | null; // MPa; null: not known here
  place: Triple; // product frame, mm
}

/// Where the product has been moved to since it came to rest: mm, deg (x, y, z in turn).
export interface Offset {
  move: Triple;
  turn: Triple;
}

const kDegree = Math.PI / 180;
type Body = Mesh<BufferGeometry, MeshStandardMaterial>;

function body(): Body {
  return new Mesh(new BufferGeometry(), new MeshStandardMaterial({ roughness: 0.85, metalness: 0, side: DoubleSide }));
}

function geometryOf(positions: Float32Array, triangles: Uint32Array): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("uv", new BufferAttribute(new Float32Array((positions.length / 3) * 2).fill(0.5), 2));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  return geometry;
}

function matrixOf(place: Place): Matrix4 {
  const [w, x, y, z] = place.quaternion;
  return new Matrix4().compose(new Vector3(...place.translation), new Quaternion(x, y, z, w), new Vector3(1, 1, 1));
}

export class BenchScene {
  readonly stage: Stage;
  private readonly skin = body();
  private readonly product = body();
  private readonly pivot = new Group();
  private readonly gizmo: TransformControls;
  private texture: DataTexture | null = null;
  private productTexture: DataTexture | null = null; // where it isn't touched it keeps its own colour
  private colours: Colours | null = null;
  private plain = new BufferGeometry(); // the product as it was opened
  private pressure = new Float32Array(0); // of the skin
  private footprint: Float32Array | null = null; // of the product as it is shown
  private regionOf = new Uint8Array(0);
  private upper = 0.1; // MPa
  private base = new Vector3(); // of the pivot, where the product came to rest
  private isGrabbed = false;
  private isDrawing = false;

  /// `moved`: while the gizmo moves the product, and once more when it is let go.
  constructor(private readonly section: HTMLElement, moved: (isOver: boolean) => void) {
    this.stage = new Stage(section, [0, 0, 1], [0, 1, 0], [1, 0, 0]);
    this.stage.use(true);
    this.stage.scene.add(this.skin, this.pivot);
    this.pivot.add(this.product);
    this.product.matrixAutoUpdate = false;
    this.gizmo = new TransformControls(this.stage.camera, this.stage.controls.domElement as HTMLElement);
    this.gizmo.setSize(0.75);
    this.gizmo.setSpace("local");
    this.stage.scene.add(this.gizmo);
    this.gizmo.addEventListener("change", () => this.draw());
    this.gizmo.addEventListener("objectChange", () => moved(false));
    this.gizmo.addEventListener("dragging-changed", (event) => {
      this.isGrabbed = Boolean((event as unknown as { value: boolean }).value);
      this.stage.controls.enabled = !this.isGrabbed;
      if (!this.isGrabbed) moved(true);
    });
  }

  /// With the browser's next frame, once for all that changed until then.
  draw(): void {
    if (this.isDrawing) return;
    this.isDrawing = true;
    requestAnimationFrame(() => {
      this.isDrawing = false;
      const start = performance.now();
      this.stage.draw();
      measured("palmar-draw", start);
    });
  }

  setHand(frame: HandFrame, isLeft: boolean): void {
    this.regionOf = frame.regionOf;
    this.skin.geometry.dispose();
    this.skin.geometry = geometryOf(new Float32Array(3 * frame.vertices), frame.triangles);
    this.pressure = new Float32Array(frame.vertices);
    this.setLeft(isLeft);
  }

  close(): void {
    this.isDrawing = true; // nothing any more
    this.gizmo.detach();
    this.gizmo.dispose();
    this.plain.dispose();
    this.texture?.dispose();
    this.productTexture?.dispose();
    this.stage.dispose();
  }

  setLeft(isLeft: boolean): void {
    this.stage.setSides([0, 0, 1], [0, 1, 0], [isLeft ? -1 : 1, 0, 0]);
  }

  setProduct(frame: MeshFrame): void {
    this.plain.dispose();
    this.plain = geometryOf(frame.positions, frame.triangles);
    this.plain.computeVertexNormals();
    this.plain.computeBoundingSphere();
    this.showPlain();
  }

  setColours(colours: Colours): void {
    this.colours = colours;
    const table = tableText(colours);
    this.texture?.dispose();
    this.texture = scaleTexture(table, colours.neutral);
    this.productTexture?.dispose();
    this.productTexture = scaleTexture(table, colours.product);
    this.paint();
  }

  /// The upper end of the scale, MPa.
  setUpper(upper: number): void {
    this.upper = upper;
    this.colourSkin();
    this.colourProduct();
    this.draw();
  }

  /// Skin and pressure; with `withProduct` also where the product is.
  setField(frame: FieldFrame, withProduct: boolean): void {
    const position = this.skin.geometry.getAttribute("position") as BufferAttribute | undefined;
    if (!position || position.array.length !== frame.positions.length) return;
    (position.array as Float32Array).set(frame.positions);
    position.needsUpdate = true;
    this.skin.geometry.computeVertexNormals();
    this.pressure = frame.pressure;
    this.colourSkin();
    if (frame.kind === "moving") this.showMoving(frame.onProduct);
    if (withProduct) this.setPlace(frame.place);
    this.skin.geometry.computeBoundingSphere();
    this.draw();
  }

  setFootprint(frame: MeshFrame): void {
    if (this.product.geometry !== this.plain) this.product.geometry.dispose();
    this.product.geometry = geometryOf(frame.positions, frame.triangles);
    this.product.geometry.computeVertexNormals();
    this.footprint = frame.pressure;
    this.colourProduct();
    this.paint();
    this.draw();
  }

  private showPlain(): void {
    if (this.product.geometry === this.plain && !this.footprint) return;
    if (this.product.geometry !== this.plain) this.product.geometry.dispose();
    this.product.geometry = this.plain;
    this.footprint = null;
    this.paint();
  }

  /// The product as it was opened with the pressure on some of its vertices, until it comes to rest.
  private showMoving(on: FieldFrame["onProduct"]): void {
    const isNew = this.product.geometry !== this.plain || !this.footprint;
    if (isNew) {
      this.showPlain();
      this.footprint = new Float32Array(this.plain.getAttribute("position").count);
      this.paint();
    } else {
      this.footprint!.fill(0);
    }
    for (let k = 0; k < on.vertex.length; ++k) this.footprint![on.vertex[k]] = on.pressure[k];
    this.colourProduct();
  }

  private shares(geometry: BufferGeometry, pressure: Float32Array): void {
    const uv = geometry.getAttribute("uv") as BufferAttribute | undefined;
    if (!uv) return;
    const array = uv.array as Float32Array;
    for (let i = 0; i < pressure.length; ++i) array[2 * i] = Math.min(1, pressure[i] / this.upper);
    uv.needsUpdate = true;
  }
  private colourSkin(): void { this.shares(this.skin.geometry, this.pressure); }
  private colourProduct(): void {
    if (this.footprint) this.shares(this.product.geometry, this.footprint);
  }

  private shown(): string {
    return this.section.querySelector<HTMLSelectElement>("[data-product]")?.value ?? "solid";
  }

  /// Colours and transparency as they are chosen.
  paint(): void {
    if (!this.colours) return;
    const material = this.skin.material;
    material.map = this.texture;
    material.color = new Color(1, 1, 1);
    material.needsUpdate = true;
    const product = this.product.material;
    const isClear = this.shown() === "clear";
    product.map = this.footprint && !isClear ? this.productTexture : null;
    product.color = product.map ? new Color(1, 1, 1) : rgb(this.colours.product);
    product.transparent = isClear;
    product.opacity = isClear ? 0.28 : 1;
    product.depthWrite = !isClear;
    product.needsUpdate = true;
    this.product.visible = this.shown() !== "hidden";
    this.skin.visible = this.shown() !== "alone";
    this.draw();
  }

  /// Where the product came to rest; the gizmo is put to `centre` (product frame, mm).
  setBase(place: Place, centre: Triple): void {
    const handFromProduct = matrixOf(place).invert();
    this.base = new Vector3(...centre).applyMatrix4(handFromProduct);
    this.pivot.position.copy(this.base);
    this.pivot.quaternion.identity();
    this.pivot.updateMatrix();
    this.product.matrix.copy(this.pivot.matrix).invert().multiply(handFromProduct);
    this.product.matrixWorldNeedsUpdate = true;
    if (!this.gizmo.object) this.gizmo.attach(this.pivot);
    this.draw();
  }

  /// Puts the product elsewhere; base and gizmo's place in it stay.
  setPlace(place: Place): void {
    this.setHandFromProduct(matrixOf(place).invert());
  }

  private setHandFromProduct(handFromProduct: Matrix4): void {
    this.pivot.matrix.copy(handFromProduct).multiply(this.product.matrix.clone().invert());
    this.pivot.matrix.decompose(this.pivot.position, this.pivot.quaternion, this.pivot.scale);
    this.pivot.scale.set(1, 1, 1);
  }

  offset(): Offset {
    const moved = this.pivot.position.clone().sub(this.base);
    const turned = new Euler().setFromQuaternion(this.pivot.quaternion, "XYZ");
    return { move: moved.toArray() as Triple, turn: [turned.x / kDegree, turned.y / kDegree, turned.z / kDegree] };
  }

  setOffset(offset: Offset): void {
    this.pivot.position.copy(this.base).add(new Vector3(...offset.move));
    this.pivot.quaternion.setFromEuler(new Euler(...(offset.turn.map((x) => x * kDegree) as Triple), "XYZ"));
    this.draw();
  }

  /// product_from_hand as the product lies now.
  place(): Place {
    this.pivot.updateMatrix();
    const productFromHand = this.pivot.matrix.clone().multiply(this.product.matrix).invert();
    const position = new Vector3(), turn = new Quaternion();
    productFromHand.decompose(position, turn, new Vector3());
    return { quaternion: [turn.w, turn.x, turn.y, turn.z], translation: position.toArray() as Triple };
  }

  /// Puts `at` (a place of the product with its direction there) to `to` (hand frame), turning the product the
  /// least way that brings the directions into one line.
  snap(at: { centre: Triple; axis: Triple }, to: { centre: Triple; axis: Triple }): void {
    this.pivot.updateMatrix();
    const now = this.pivot.matrix.clone().multiply(this.product.matrix); // hand from product
    const axis = new Vector3(...at.axis).transformDirection(now), wanted = new Vector3(...to.axis);
    if (axis.dot(wanted) < 0) wanted.negate();
    const next = new Matrix4().makeRotationFromQuaternion(new Quaternion().setFromUnitVectors(axis, wanted)).multiply(now);
    const moved = new Vector3(...to.centre).sub(new Vector3(...at.centre).applyMatrix4(next));
    this.setHandFromProduct(new Matrix4().makeTranslation(moved).multiply(next));
    this.draw();
  }

  /// A place of the product and its direction there in the hand's frame.
  inHand(at: { centre: Triple; axis: Triple }): { centre: Triple; axis: Triple } {
    this.pivot.updateMatrix();
    const now = this.pivot.matrix.clone().multiply(this.product.matrix);
    return { centre: new Vector3(...at.centre).applyMatrix4(now).toArray() as Triple, axis: new Vector3(...at.axis).transformDirection(now).toArray() as Triple };
  }

  setMode(mode: "translate" | "rotate"): void {
    this.gizmo.setMode(mode);
    this.draw();
  }

  /// The whole hand, from the thumb's side and a little from the palm.
  lookAtHand(from = "thumb"): void {
    const sphere = this.skin.geometry.boundingSphere;
    if (sphere) this.stage.frame(sphere.center, sphere.radius);
    this.stage.look(from);
    this.stage.use(true);
  }

  onPointed(tell: (pointed: Pointed | null) => void): void {
    this.stage.onPoint(() => [this.skin, this.product].filter((one) => one.visible), (hits) => {
      tell(this.isGrabbed ? null : this.pointed(hits));
    });
  }

  private pointed(hits: Intersection[]): Pointed | null {
    const isClear = this.shown() === "clear";
    const skin = hits.find((hit) => hit.object === this.skin);
    const hit = isClear ? skin ?? hits[0] : hits[0];
    if (!hit?.face) return null;
    this.product.updateWorldMatrix(true, false);
    const place = hit.point.clone().applyMatrix4(this.product.matrixWorld.clone().invert()).toArray() as Triple;
    const nearest = (values: Float32Array) => {
      const corners = [hit.face!.a, hit.face!.b, hit.face!.c];
      return Math.max(...corners.map((corner) => values[corner]));
    };
    if (hit.object === this.skin) return { region: this.regionOf[hit.face.a], pressure: nearest(this.pressure), place };
    return { region: null, pressure: this.footprint ? nearest(this.footprint) : null, place };
  }

  /// What is seen, small, without the gizmo: as a data URL.
  miniature(): string {
    const width = 144, height = 92;
    const view = this.stage.controls.domElement as HTMLCanvasElement;
    this.gizmo.visible = false;
    this.stage.draw();
    const small = document.createElement("canvas");
    small.width = width;
    small.height = height;
    const share = Math.min(view.width / width, view.height / height); // the middle, without borders
    const w = share * width, h = share * height;
    small.getContext("2d")?.drawImage(view, (view.width - w) / 2, (view.height - h) / 2, w, h, 0, 0, width, height);
    this.gizmo.visible = true;
    this.draw();
    return small.toDataURL("image/jpeg", 0.8);
  }

  /// Pictures of holds: hand and product as small images.
  thumbnails(previews: FieldFrame[], isLeft: boolean): string[] {
    const width = 264, height = 168;
    const renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    renderer.setSize(width, height);
    renderer.setClearColor(0xffffff);
    const scene = new Scene();
    scene.add(new HemisphereLight(0xffffff, 0xb8b4ae, 1.7));
    const camera = new PerspectiveCamera(28, width / height, 1, 4000);
    const light = new DirectionalLight(0xffffff, 1.7);
    scene.add(light);
    const product = new Mesh(this.plain, new MeshStandardMaterial({ color: rgb(this.colours!.product), roughness: 0.85, side: DoubleSide }));
    const skin = new Mesh(new BufferGeometry(), new MeshStandardMaterial({ color: rgb(this.colours!.skin), roughness: 0.85 }));
    skin.matrixAutoUpdate = false;
    scene.add(product, skin);
    const index = this.skin.geometry.getIndex()!;
    const pictures = previews.map((preview) => {
      skin.geometry = new BufferGeometry();
      skin.geometry.setAttribute("position", new BufferAttribute(preview.positions, 3));
      skin.geometry.setIndex(index);
      skin.geometry.computeVertexNormals();
      skin.geometry.computeBoundingSphere();
      // In the product's frame, upright, so that holds that differ in how the hand is turned look so.
      const productFromHand = matrixOf(preview.place);
      skin.matrix.copy(productFromHand);
      const turn = new Quaternion().setFromRotationMatrix(productFromHand);
      const from = new Vector3(isLeft ? -0.8 : 0.8, 0.1, 0.6).applyQuaternion(turn);
      camera.up.set(0, 0, 1);
      // Not along the axis that is upright: from above, or from the fingers' side.
      if (Math.abs(from.z) > 0.75) from.add(new Vector3(0, 0, 1).applyQuaternion(turn).multiplyScalar(0.9));
      from.z = Math.max(from.z, 0.15);
      from.normalize();
      const centre = skin.geometry.boundingSphere!.center.clone().applyMatrix4(productFromHand);
      camera.position.copy(centre).addScaledVector(from, skin.geometry.boundingSphere!.radius * 3.7);
      camera.lookAt(centre);
      light.position.copy(from).add(new Vector3(0, 0, 0.6));
      light.target.position.set(0, 0, 0);
      renderer.render(scene, camera);
      const picture = renderer.domElement.toDataURL("image/png");
      skin.geometry.dispose();
      return picture;
    });
    skin.material.dispose();
    product.material.dispose();
    renderer.dispose();
    renderer.forceContextLoss();
    return pictures;
  }
}
