// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Numbers and sliders for where the product is and how the joints stand.
import { el, fill } from "./dom";
import { say, TextKey } from "./say";
import { Offset } from "./scene";
import { Triple } from "./live_frame";

export interface Angle {
  name: string; // "index_mcp_flexion"
  lower_deg: number;
  upper_deg: number;
  reference_deg: number;
}

export interface PoseEvents {
  /// The product was moved; `isOver` when the number stands.
  offset(offset: Offset, isOver: boolean): void;
  angles(degrees: number[], isOver: boolean): void;
}

/// "index_mcp_flexion" -> index finger, "MCP flexion".
export function angleWords(name: string): { finger: TextKey; words: string } {
  const parts = name.split("_");
  const finger = `finger.${parts[0]}` as TextKey;
  const kind = say(`joint.${parts[parts.length - 1]}` as TextKey);
  return { finger, words: parts.length > 2 ? `${parts[1].toUpperCase()} ${kind}` : kind };
}

/// DIP joints go along with PIP joints at two thirds of their angle (Rijkpema & Girard 1991), as the
/// program closes fingers.
export function linkedAngles(degrees: number[], changed: string, angles: Angle[]): number[] {
  const match = /^(index|middle|ring|little)_pip_flexion$/.exec(changed);
  if (!match) return degrees;
  const pip = angles.findIndex((one) => one.name === changed);
  const dip = angles.findIndex((one) => one.name === `${match[1]}_dip_flexion`);
  if (dip < 0) return degrees;
  const next = [...degrees];
  next[dip] = Math.min(angles[dip].upper_deg, Math.max(angles[dip].lower_deg, (2 / 3) * degrees[pip]));
  return next;
}

function rounded(value: number): string {
  return String(Math.round(value * 10) / 10 || 0);
}

export class PosePanel {
  private readonly fields: HTMLInputElement[] = [];
  private readonly joints = el("div", { class: "joints" });
  private sliders: { range: HTMLInputElement; number: HTMLInputElement }[] = [];
  private angles: Angle[] = [];
  private degrees: number[] = [];
  readonly place: HTMLElement;

  constructor(private readonly events: PoseEvents) {
    const row = (label: TextKey, unit: string, first: number) => el("div", { class: "triple" },
      el("span", { class: "label" }, `${say(label)}, ${unit}`),
      ["x", "y", "z"].map((axis, k) => {
        const input = el("input", { type: "number", step: unit === "mm" ? 0.5 : 1, value: 0, "data-offset": `${first === 0 ? "move" : "turn"}-${axis}`,
          "aria-label": `${say(label)} ${axis}, ${unit}` });
        input.addEventListener("input", () => this.changed(false));
        input.addEventListener("change", () => this.changed(true));
        this.fields[first + k] = input;
        return el("label", {}, axis, input);
      }));
    this.place = el("div", {}, row("bench.move", "mm", 0), row("bench.turn", "°", 3));
  }

  get jointsElement(): HTMLElement { return this.joints; }

  private changed(isOver: boolean): void {
    const values = this.fields.map((one) => Number(one.value));
    if (values.some((one) => !Number.isFinite(one) || Math.abs(one) > 1000)) return;
    this.events.offset({ move: values.slice(0, 3) as Triple, turn: values.slice(3) as Triple }, isOver);
  }

  setOffset(offset: Offset): void {
    [...offset.move, ...offset.turn].forEach((value, k) => {
      if (document.activeElement !== this.fields[k]) this.fields[k].value = rounded(value);
    });
  }

  setHand(angles: Angle[]): void {
    this.angles = angles;
    this.degrees = angles.map((one) => one.reference_deg);
    this.sliders = [];
    const groups = new Map<TextKey, HTMLElement[]>();
    angles.forEach((angle, k) => {
      const { finger, words } = angleWords(angle.name);
      const label = `${say(finger)}: ${words}, °`;
      const limits = { min: Math.round(angle.lower_deg), max: Math.round(angle.upper_deg), "aria-label": label, "data-angle": angle.name };
      const range = el("input", { type: "range", step: 1, ...limits });
      const number = el("input", { type: "number", step: 1, ...limits });
      const change = (from: HTMLInputElement, isOver: boolean) => () => {
        const value = Number(from.value);
        if (!Number.isFinite(value)) return;
        this.degrees[k] = Math.min(angle.upper_deg, Math.max(angle.lower_deg, value));
        this.degrees = linkedAngles(this.degrees, angle.name, this.angles);
        this.show(from);
        this.events.angles([...this.degrees], isOver);
      };
      for (const input of [range, number]) {
        input.addEventListener("input", change(input, false));
        input.addEventListener("change", change(input, true));
      }
      this.sliders.push({ range, number });
      const rows = groups.get(finger) ?? [];
      rows.push(el("label", { class: "joint" }, el("span", {}, words), range, number));
      groups.set(finger, rows);
    });
    fill(this.joints, [...groups].map(([finger, rows]) => el("details", {}, el("summary", {}, say(finger)), rows)));
    this.show(null);
  }

  private show(except: HTMLInputElement | null): void {
    this.sliders.forEach(({ range, number }, k) => {
      if (range !== except) range.value = String(this.degrees[k]);
      if (number !== except && document.activeElement !== number) number.value = String(Math.round(this.degrees[k]));
    });
  }

  setAngles(degrees: ArrayLike<number>): void {
    if (degrees.length !== this.angles.length) return;
    this.degrees = Array.from(degrees);
    this.show(null);
  }
}
