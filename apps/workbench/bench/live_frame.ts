// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What the server sends as bytes (src/palmar/server/live_frame.h): meshes once, then fields.

export const frameMagic = 0x314d4c50; // "PLM1"
export const dofCount = 23;

export type Quaternion = [number, number, number, number]; // w, x, y, z
export type Triple = [number, number, number];

export interface Place {
  quaternion: Quaternion; // of product_from_hand
  translation: Triple; // mm
}

export interface Totals {
  force: number; // N
  area: number; // mm²
  peak: number; // MPa, at a vertex
  peakCells: number; // MPa, mean over a sensor cell
  mean: number; // MPa
}

export interface RegionRow extends Totals {
  region: number;
}

export interface HandFrame {
  kind: "hand";
  request: number;
  vertices: number;
  triangles: Uint32Array; // 3 each
  regionOf: Uint8Array; // per vertex
}

export interface MeshFrame {
  kind: "product" | "footprint";
  request: number;
  positions: Float32Array; // product frame, mm
  triangles: Uint32Array;
  pressure: Float32Array; // MPa per vertex; empty of a product
}

export interface FieldFrame {
  kind: "moving" | "rest" | "preview";
  request: number;
  number: number; // of the hold that is previewed
  place: Place;
  gripForce: number; // N
  total: Totals;
  status: number; // 0 solved, 1 no contact, 2 not converged, 3 too deep
  postureDeg: Float32Array; // dofCount
  regions: RegionRow[];
  positions: Float32Array; // hand frame, mm
  pressure: Float32Array; // MPa per vertex
  onProduct: { vertex: Uint32Array; pressure: Float32Array }; // while it moves: the product's vertices that are pressed on
}

export type Frame = HandFrame | MeshFrame | FieldFrame;

class Reader {
  at = 0;
  private readonly view: DataView;
  constructor(private readonly buffer: ArrayBuffer) {
    this.view = new DataView(buffer);
  }
  private take(bytes: number): number {
    if (this.at + bytes > this.buffer.byteLength) {
      throw new Error(`live frame: ${this.buffer.byteLength} bytes; ${this.at + bytes} are needed`);
    }
    const start = this.at;
    this.at += bytes;
    return start;
  }
  u32(): number { return this.view.getUint32(this.take(4), true); }
  f32(): number { return this.view.getFloat32(this.take(4), true); }
  f64(): number { return this.view.getFloat64(this.take(8), true); }
  // Copies, as what follows need not stand at a multiple of its size.
  private part(count: number, size: number): ArrayBuffer {
    const start = this.take(count * size);
    return this.buffer.slice(start, start + count * size);
  }
  bytes(count: number): Uint8Array { return new Uint8Array(this.part(count, 1)); }
  u16s(count: number): Uint16Array { return new Uint16Array(this.part(count, 2)); }
  u32s(count: number): Uint32Array { return new Uint32Array(this.part(count, 4)); }
  f32s(count: number): Float32Array { return new Float32Array(this.part(count, 4)); }
}

function totals(from: Reader): Totals {
  return { force: from.f32(), area: from.f32(), peak: from.f32(), peakCells: from.f32(), mean: from.f32() };
}

function field(from: Reader, kind: FieldFrame["kind"], request: number, number: number): FieldFrame {
  const quaternion: Quaternion = [from.f64(), from.f64(), from.f64(), from.f64()];
  const translation: Triple = [from.f64(), from.f64(), from.f64()];
  const gripForce = from.f32();
  const total = totals(from);
  const status = from.u32();
  const postureDeg = from.f32s(dofCount);
  const low = [from.f32(), from.f32(), from.f32()];
  const step = from.f32();
  const pressureStep = from.f32();
  const regions: RegionRow[] = [];
  for (let left = from.u32(); left > 0; --left) regions.push({ region: from.f32(), ...totals(from) });
  const vertices = from.u32();
  const steps = from.u16s(3 * vertices);
  const positions = new Float32Array(3 * vertices);
  for (let i = 0; i < positions.length; i += 3) {
    positions[i] = low[0] + step * steps[i];
    positions[i + 1] = low[1] + step * steps[i + 1];
    positions[i + 2] = low[2] + step * steps[i + 2];
  }
  const pressures = (count: number) => {
    const shares = from.u16s(count);
    const read = new Float32Array(count);
    for (let i = 0; i < count; ++i) read[i] = pressureStep * shares[i];
    return read;
  };
  const pressure = pressures(vertices);
  const pressed = from.u32();
  const onProduct = { vertex: from.u32s(pressed), pressure: pressures(pressed) };
  return { kind, request, number, place: { quaternion, translation }, gripForce, total, status, postureDeg, regions, positions, pressure, onProduct };
}

/// Throws an Error for what is no such frame or is cut off.
export function decodeFrame(buffer: ArrayBuffer): Frame {
  const from = new Reader(buffer);
  const magic = from.u32();
  if (magic !== frameMagic) throw new Error(`live frame: it begins with ${magic}, not with PLM1`);
  const kind = from.u32(), request = from.u32(), number = from.u32();
  switch (kind) {
    case 1: {
      const vertices = from.u32(), triangles = from.u32();
      return { kind: "hand", request, vertices, triangles: from.u32s(3 * triangles), regionOf: from.bytes(vertices) };
    }
    case 2:
    case 6: {
      const vertices = from.u32(), triangles = from.u32();
      const positions = from.f32s(3 * vertices), indices = from.u32s(3 * triangles);
      const pressure = kind === 6 ? from.f32s(vertices) : new Float32Array(0);
      return { kind: kind === 6 ? "footprint" : "product", request, positions, triangles: indices, pressure };
    }
    case 3: return field(from, "moving", request, number);
    case 4: return field(from, "rest", request, number);
    case 5: return field(from, "preview", request, number);
    default: throw new Error(`live frame: kind ${kind} is not known`);
  }
}
