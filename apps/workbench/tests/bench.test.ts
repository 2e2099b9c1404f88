// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { test } from "node:test";
import { keptHistory, keptText } from "../bench/kept_steps";
import { BenchState, needsOpening, openRequest, stateRequest } from "../bench/bench_state";
import { dotSummaries } from "../bench/dots";
import { decodeFrame, FieldFrame, MeshFrame } from "../bench/live_frame";
import { MoveQueue } from "../bench/move_queue";
import { parseProject, Project, projectText } from "../bench/project";
import { tickStep } from "../bench/ticks";
import { UndoStack } from "../bench/undo";
import english from "../bench/texts/en.json";
import german from "../bench/texts/de.json";

const state: BenchState = { product: "p1", holder: { person: "", left: false }, gripForce: 60, hold: 2, pose: null, settle: null };

/// Bytes as the server writes them: [kind of number, value] one after the other.
function bytes(parts: [string, number][]): ArrayBuffer {
  const sizes: Record<string, number> = { u8: 1, u16: 2, u32: 4, f32: 4, f64: 8 };
  const buffer = new ArrayBuffer(parts.reduce((sum, [kind]) => sum + sizes[kind], 0));
  const view = new DataView(buffer);
  let at = 0;
  for (const [kind, value] of parts) {
    if (kind === "u8") view.setUint8(at, value);
    if (kind === "u16") view.setUint16(at, value, true);
    if (kind === "u32") view.setUint32(at, value, true);
    if (kind === "f32") view.setFloat32(at, value, true);
    if (kind === "f64") view.setFloat64(at, value, true);
    at += sizes[kind];
  }
  return buffer;
}

function head(kind: number, request = 7, number = 0): [string, number][] {
  return [["u32", 0x314d4c50], ["u32", kind], ["u32", request], ["u32", number]];
}

function fieldBytes(): ArrayBuffer {
  const parts = head(3, 7);
  for (const value of [1, 0, 0, 0, 10, 20, 30]) parts.push(["f64", value]);
  for (const value of [60, 150, 3700, 0.2, 0.15, 0.04]) parts.push(["f32", value]);
  parts.push(["u32", 0]);
  for (let k = 0; k < 23; ++k) parts.push(["f32", k]);
  for (const value of [-5, 0, 5, 0.5, 0.001]) parts.push(["f32", value]);
  parts.push(["u32", 1]);
  for (const value of [15, 150, 3700, 0.2, 0.15, 0.04]) parts.push(["f32", value]);
  parts.push(["u32", 2]);
  for (const value of [0, 2, 4, 65535, 0, 1]) parts.push(["u16", value]);
  for (const value of [0, 200]) parts.push(["u16", value]);
  parts.push(["u32", 2], ["u32", 3], ["u32", 70000], ["u16", 50], ["u16", 100]);
  return bytes(parts);
}

test("a field is read as it was written", () => {
  const frame = decodeFrame(fieldBytes()) as FieldFrame;
  assert.equal(frame.kind, "moving");
  assert.equal(frame.request, 7);
  assert.deepEqual(frame.place, { quaternion: [1, 0, 0, 0], translation: [10, 20, 30] });
  assert.equal(frame.gripForce, 60);
  assert.equal(frame.total.area, 3700);
  assert.equal(frame.postureDeg[22], 22);
  assert.equal(frame.regions.length, 1);
  assert.equal(frame.regions[0].region, 15);
  assert.deepEqual(Array.from(frame.positions), [-5, 1, 7, 32762.5, 0, 5.5]);
  assert.ok(Math.abs(frame.pressure[1] - 0.2) < 1e-6 && frame.pressure[0] === 0);
  assert.deepEqual(Array.from(frame.onProduct.vertex), [3, 70000]);
  assert.deepEqual(Array.from(frame.onProduct.pressure, (one) => one.toFixed(3)), ["0.050", "0.100"]);
});

test("a footprint has a pressure for each vertex, a product none", () => {
  const mesh: [string, number][] = [["u32", 3], ["u32", 1]];
  for (let k = 0; k < 9; ++k) mesh.push(["f32", k]);
  for (const corner of [0, 2, 1]) mesh.push(["u32", corner]);
  const product = decodeFrame(bytes([...head(2), ...mesh])) as MeshFrame;
  assert.deepEqual([product.kind, product.pressure.length], ["product", 0]);
  const footprint = decodeFrame(bytes([...head(6), ...mesh, ["f32", 0.5], ["f32", 0], ["f32", 0.25]])) as MeshFrame;
  assert.deepEqual([footprint.kind, Array.from(footprint.pressure)], ["footprint", [0.5, 0, 0.25]]);
  assert.deepEqual(Array.from(footprint.triangles), [0, 2, 1]);
});

test("what is cut off or no frame is refused", () => {
  const whole = fieldBytes();
  for (const size of [0, 3, 16, 100, whole.byteLength - 1]) {
    assert.throws(() => decodeFrame(whole.slice(0, size)), /bytes; \d+ are needed/);
  }
  assert.throws(() => decodeFrame(bytes([["u32", 1], ["u32", 3], ["u32", 0], ["u32", 0]])), /not with PLM1/);
  assert.throws(() => decodeFrame(bytes(head(99))), /kind 99 is not known/);
});

test("ten steps are undone and done again", () => {
  const stack = new UndoStack<number>();
  for (let k = 0; k <= 10; ++k) assert.equal(stack.push(k), true);
  assert.equal(stack.push(10), false, "what doesn't change anything is no step");
  for (let k = 9; k >= 0; --k) assert.equal(stack.undo(), k);
  assert.equal(stack.undo(), null);
  for (let k = 1; k <= 10; ++k) assert.equal(stack.redo(), k);
  assert.equal(stack.redo(), null);
});

test("a new step takes the place of those that were undone", () => {
  const stack = new UndoStack<string>();
  for (const one of ["a", "b", "c"]) stack.push(one);
  stack.undo();
  stack.undo();
  stack.push("d");
  assert.equal(stack.canRedo(), false);
  assert.equal(stack.undo(), "a");
});

test("the stack forgets the oldest steps", () => {
  const stack = new UndoStack<number>(3);
  for (let k = 0; k < 10; ++k) stack.push(k);
  assert.equal(stack.undo(), 8);
  assert.equal(stack.undo(), 7);
  assert.equal(stack.undo(), null);
});

test("states that were kept don't change with what is done later", () => {
  const stack = new UndoStack<{ list: number[] }>();
  const first = { list: [1] };
  stack.push(first);
  first.list.push(2);
  stack.push(first);
  assert.deepEqual(stack.undo(), { list: [1] });
});

test("any step can be gone to, and steps read back from where they were kept", () => {
  const stack = new UndoStack<number>();
  let made = 0;
  const picture = () => `data:image/jpeg;base64,${++made}`;
  for (const one of [5, 5, 6, 7]) stack.push(one, picture);
  assert.equal(made, 3, "a picture is made for steps alone");
  assert.equal(stack.goTo(0), 5);
  assert.equal(stack.goTo(3), null);
  assert.equal(stack.goTo(-1), null);
  assert.equal(stack.at, 0);
  assert.deepEqual(stack.pictures.map((one) => one.slice(-1)), ["1", "2", "3"]);
  stack.goTo(1);
  const kept = stack.steps(60);
  const other = new UndoStack<number>();
  other.restore(kept.steps, kept.at);
  assert.deepEqual([other.undo(), other.redo(), other.redo(), other.redo()], [5, 6, 7, null]);
  assert.deepEqual(stack.steps(2), { at: 0, steps: kept.steps.slice(1) }, "the latest, with where one is among them");
});

test("what is kept by itself reads back with the product as it lies on the shelf then", () => {
  const other: BenchState = { ...state, holder: { person: "man:P95", left: true }, gripForce: null };
  const history = { at: 1, steps: [{ state, picture: "data:image/jpeg;base64,A" }, { state: other, picture: `data:image/jpeg;base64,${"A".repeat(50000)}` }] };
  const kept = JSON.parse(keptText(other, history));
  assert.equal(kept.product, "p1");
  assert.equal(kept.picture, "", "a picture that is too large is left out");
  const back = keptHistory(kept.history, "p9");
  assert.deepEqual(back, { at: 1, steps: [{ state: { ...state, product: "p9" }, picture: "data:image/jpeg;base64,A" }, { state: { ...other, product: "p9" }, picture: "" }] });
  for (const damaged of [null, 7, {}, { at: 2, steps: kept.history.steps }, { at: 0, steps: [{ state: { hold: "x" }, picture: "" }] }]) {
    assert.equal(keptHistory(damaged, "p9"), null);
  }
});

test("dots are summed up over the hands of the length that is asked for", () => {
  const dots = {
    products: [{ name: "a", colour: [0, 0, 0] as [number, number, number] }, { name: "b", colour: [0, 0, 0] as [number, number, number] }],
    hands: [{ length_mm: 170, shown: 0 }, { length_mm: 180, shown: 1 }, { length_mm: 190, shown: null }, { length_mm: null, shown: null }],
    quantities: [{ key: "area", name: "area", unit: "mm2" }],
    grasps: [0, 1, 2, 3].flatMap((hand) => [{ hand, product: 0, outcome: "held", values: [10 * (hand + 1)] }, { hand, product: 1, outcome: "slips_out", values: [null] }]),
  };
  // Of 10, 20, 30, 40 the mean is 25, the standard deviation the root of 500 / 3.
  const all = dotSummaries(dots, 0, 170, 190, true);
  assert.deepEqual([all[0].held, all[0].hands, all[0].mean], [4, 4, 25]);
  assert.ok(Math.abs(all[0].sd! - Math.sqrt(500 / 3)) < 1e-12);
  assert.deepEqual(all[1], { name: "b", held: 0, hands: 4, mean: null, sd: null });
  const long = dotSummaries(dots, 0, 175, 190, false);
  assert.deepEqual([long[0].held, long[0].mean], [2, 25]);
});

test("of motions one is on its way and the newest follows", () => {
  const sent: number[] = [];
  let id = 0;
  const queue = new MoveQueue((request) => {
    sent.push(request.step as number);
    return ++id;
  });
  for (let step = 1; step <= 5; ++step) queue.move({ do: "move", step });
  assert.deepEqual(sent, [1]);
  queue.answered(99); // somebody else's
  assert.deepEqual(sent, [1]);
  queue.answered(1);
  assert.deepEqual(sent, [1, 5]);
  queue.answered(2);
  assert.deepEqual(sent, [1, 5]);
  queue.move({ do: "move", step: 6 });
  assert.deepEqual(sent, [1, 5, 6]);
  queue.reset();
  queue.move({ do: "move", step: 7 });
  assert.deepEqual(sent, [1, 5, 6, 7], "what is stale isn't waited for");
});

test("a state says what shows it", () => {
  assert.deepEqual(stateRequest(state), { do: "hold", number: 2, grip_force_n: 60 });
  assert.deepEqual(stateRequest({ ...state, gripForce: null }), { do: "hold", number: 2 });
  const pose = { postureDeg: [1, 2], place: { quaternion: [1, 0, 0, 0] as [number, number, number, number], translation: [1, 2, 3] as [number, number, number] }, grip: "tripod" };
  assert.deepEqual(stateRequest({ ...state, pose }), { do: "evaluate", posture_deg: [1, 2], product_from_hand: { quaternion_wxyz: [1, 0, 0, 0], translation_mm: [1, 2, 3] }, grip: "tripod" });
  assert.deepEqual(Object.keys(stateRequest({ ...state, pose, settle: "close" })), ["do", "posture_deg", "product_from_hand", "grip", "grip_force_n"]);
  assert.equal(stateRequest({ ...state, pose, settle: "close" }).do, "close");
  assert.equal(openRequest({ ...state, holder: { person: "woman:P5", left: true } }, "de").person, "woman:P5");
  assert.equal(needsOpening(null, state), true);
  assert.equal(needsOpening(state, { ...state, hold: 1, gripForce: null }), false);
  assert.equal(needsOpening(state, { ...state, holder: { person: "", left: true } }), true);
});

test("a project reads back exactly and says what is wrong with it", () => {
  const bytes = new Uint8Array(70000);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = (i * 7919) % 256;
  const pose = { postureDeg: Array.from({ length: 23 }, (_, k) => k / 3), place: { quaternion: [0.6, 0, 0.8, 0] as [number, number, number, number], translation: [0.1, -2.7, 3] as [number, number, number] }, grip: "medium_wrap" };
  const project: Project = { fileName: "a b.stl", unit: "mm", bytes, hand: null, state: { holder: { person: "man:P95", left: true }, gripForce: 33.3, hold: 2, pose, settle: "close" } };
  assert.deepEqual(parseProject(projectText(project)), project);
  const plain: Project = { ...project, unit: null, state: { holder: { person: "", left: false }, gripForce: null, hold: 1, pose: null, settle: null } };
  assert.deepEqual(parseProject(projectText(plain)), plain);
  const own: Project = { ...plain, hand: { fileName: "anna.hand.glb", bytes: new Uint8Array([103, 108, 84, 70]) } };
  assert.deepEqual(parseProject(projectText(own)), own);
  const changed = (change: (json: Record<string, any>) => void) => () => {
    const json = JSON.parse(projectText(project));
    change(json);
    parseProject(JSON.stringify(json));
  };
  assert.throws(() => { parseProject("{"); }, /no JSON/);
  assert.throws(() => { parseProject("[]"); }, /an object is required/);
  assert.throws(changed((json) => { json.palmar_project = 2; }), /"palmar_project" is 2; 1 is read here/);
  assert.throws(changed((json) => { delete json.product; }), /"product".*an object/);
  assert.throws(changed((json) => { json.product.bytes_base64 = "%%%"; }), /base64 is required/);
  assert.throws(changed((json) => { json.pose.posture_deg = [1]; }), /23 numbers/);
  assert.throws(changed((json) => { json.hold = 1.5; }), /whole number/);
  assert.throws(changed((json) => { json.settle = "fly"; }), /close, rest or null/);
  assert.throws(changed((json) => { json.grip_force_n = "60"; }), /grip_force_n/);
});

test("scales have 4 to 9 round ticks", () => {
  for (let upper = 3; upper < 5000; upper *= 1.07) {
    const step = tickStep(upper);
    const count = Math.floor(upper / step + 1e-9);
    assert.ok(count >= 3 && count <= 9, `${upper}: ${count} of ${step}`);
    assert.match((step / 10 ** Math.floor(Math.log10(step) + 1e-9)).toPrecision(3), /^(1\.00|2\.00|2\.50|5\.00)$/);
  }
});

test("both languages say the same, and all of it is used", () => {
  assert.deepEqual(Object.keys(english), Object.keys(german));
  const sources = readdirSync("apps/workbench/bench").filter((name) => name.slice(-3) === ".ts")
    .map((name) => readFileSync(`apps/workbench/bench/${name}`, "utf8")).join("\n");
  // `job.kind.${...}`: all that begin so; what begins with bench alone is listed below.
  const groups = [...sources.matchAll(/`([a-z_.]+[._])\$\{/g)].map((match) => match[1]).filter((group) => group !== "bench.");
  for (const [key, text] of Object.entries(english)) {
    const other = (german as Record<string, string>)[key];
    assert.ok(text.length > 0 && other.length > 0, key);
    assert.deepEqual((text.match(/\{[a-z_]+\}/g) ?? []).sort(), (other.match(/\{[a-z_]+\}/g) ?? []).sort(), key);
    const isTotal = /^bench\.(grip_force|contact_force|area|peak|mean|woman|man)$/.test(key);
    assert.ok(sources.indexOf(`"${key}"`) >= 0 || isTotal || groups.some((group) => key.indexOf(group) === 0), `${key} is used nowhere`);
  }
});
