// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A project as a file: the product as it was opened, and what stands on the bench. The same program
// shows the same figures of it.
import { BenchState, Pose } from "./bench_state";
import { dofCount } from "./live_frame";

export const projectEnding = ".palmar-project";
const kVersion = 1;

export interface Project {
  fileName: string;
  unit: string | null; // as the user said
  bytes: Uint8Array; // of the product's file
  hand: { fileName: string; bytes: Uint8Array } | null; // a person's own; the state's person is then ""
  state: Omit<BenchState, "product">;
}

function fromBase64(value: unknown): Uint8Array {
  let raw: string;
  try {
    raw = atob(text(value, "bytes_base64"));
  } catch {
    return fail("bytes_base64", "base64");
  }
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

function toBase64(bytes: Uint8Array): string {
  const parts: string[] = [];
  for (let at = 0; at < bytes.length; at += 0x6000) parts.push(String.fromCharCode(...bytes.subarray(at, at + 0x6000)));
  return btoa(parts.join(""));
}

/// What stands on the bench, as files have it: without the product.
export function stateMembers(state: Omit<BenchState, "product">): Record<string, unknown> {
  const { holder, gripForce, hold, pose, settle } = state;
  return {
    hand: { person: holder.person || null, left: holder.left },
    grip_force_n: gripForce,
    hold,
    pose: pose && { posture_deg: pose.postureDeg, quaternion_wxyz: pose.place.quaternion, translation_mm: pose.place.translation, grip: pose.grip },
    settle,
  };
}

export function projectText(project: Project): string {
  const members = stateMembers(project.state) as { hand: object };
  const file = project.hand && { file_name: project.hand.fileName, bytes_base64: toBase64(project.hand.bytes) };
  return JSON.stringify({
    palmar_project: kVersion,
    product: { file_name: project.fileName, unit: project.unit, bytes_base64: toBase64(project.bytes) },
    ...members, hand: { ...members.hand, ...(file ? { file } : {}) },
  }, null, 1);
}

type Json = Record<string, unknown>;

function fail(member: string, needed: string): never {
  throw new Error(`"${member}" is not what a project has there: ${needed} is required`);
}
function object(value: unknown, member: string): Json {
  return typeof value === "object" && value !== null && !Array.isArray(value) ? (value as Json) : fail(member, "an object");
}
function text(value: unknown, member: string): string {
  return typeof value === "string" ? value : fail(member, "a text");
}
function numbers<T>(value: unknown, count: number, member: string): T {
  if (!Array.isArray(value) || value.length !== count || !value.every((one) => typeof one === "number" && isFinite(one))) {
    return fail(member, `a list of ${count} numbers`);
  }
  return value as unknown as T;
}

function poseOf(value: unknown): Pose | null {
  if (value === null) return null;
  const pose = object(value, "pose");
  return {
    postureDeg: numbers(pose.posture_deg, dofCount, "posture_deg"),
    place: { quaternion: numbers(pose.quaternion_wxyz, 4, "quaternion_wxyz"), translation: numbers(pose.translation_mm, 3, "translation_mm") },
    grip: text(pose.grip, "grip"),
  };
}

/// Throws an Error that names what is wrong.
export function parseState(all: Json): Omit<BenchState, "product"> {
  const hand = object(all.hand, "hand");
  const force = all.grip_force_n, hold = all.hold, settle = all.settle;
  if (force !== null && !(typeof force === "number" && force > 0)) fail("grip_force_n", "a number above 0 or null");
  if (!(typeof hold === "number" && hold >= 1 && hold % 1 === 0)) return fail("hold", "a whole number from 1");
  if (settle !== null && settle !== "close" && settle !== "rest") return fail("settle", "close, rest or null");
  return {
    holder: { person: hand.person === null ? "" : text(hand.person, "person"), left: hand.left === true },
    gripForce: force as number | null, hold, pose: poseOf(all.pose), settle,
  };
}

/// Throws as parseState() does.
export function parseProject(content: string): Project {
  let json: unknown;
  try {
    json = JSON.parse(content);
  } catch {
    throw new Error("it is no JSON");
  }
  const all = object(json, "project");
  if (all.palmar_project !== kVersion) {
    throw new Error(`its "palmar_project" is ${JSON.stringify(all.palmar_project)}; ${kVersion} is read here`);
  }
  const product = object(all.product, "product");
  const state = parseState(all);
  const file = (all.hand as Json).file;
  const hand = file ? object(file, "file") : null;
  return {
    fileName: text(product.file_name, "file_name"),
    unit: product.unit === null ? null : text(product.unit, "unit"),
    bytes: fromBase64(product.bytes_base64), state,
    hand: hand && { fileName: text(hand.file_name, "file_name"), bytes: fromBase64(hand.bytes_base64) },
  };
}
