// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A product put so that a place on one of its parts lies where the hand held it, along the same direction.
import { el, fill } from "./dom";
import { Triple } from "./live_frame";
import { stationAt, Station } from "./part_line";
import { say } from "./say";

export interface ShownPart {
  number: number;
  name: string;
  kind: string;
  line: Station[];
}

/// Which part, and where along it.
export class SnapPanel {
  readonly element: HTMLElement;
  private readonly part = el("select", { "data-snap": "part", "aria-label": say("snap.part") });
  private readonly along = el("input", { type: "range", min: 0, max: 100, step: 1, value: 50, "data-snap": "along", "aria-label": `${say("snap.along")}, %` });
  private parts: ShownPart[] = [];

  /// `snapped`: while the slider moves, and once more when it is let go.
  constructor(private readonly snapped: (at: { centre: Triple; axis: Triple }, isOver: boolean) => void) {
    this.element = el("div", { class: "snap" }, el("label", {}, el("span", {}, say("snap.to")), this.part), el("label", {}, el("span", {}, say("snap.along")), this.along));
    this.part.addEventListener("change", () => this.tell(true));
    this.along.addEventListener("input", () => this.tell(false));
    this.along.addEventListener("change", () => this.tell(true));
    this.show([]);
  }

  show(parts: ShownPart[]): void {
    this.parts = parts.filter((one) => one.line.length > 0);
    fill(this.part, el("option", { value: "" }, say("snap.none")), this.parts.map((one) => el("option", { value: one.number }, `${one.number}: ${one.name}`)));
    this.element.hidden = this.parts.length === 0;
    this.along.disabled = true;
  }

  private tell(isOver: boolean): void {
    const part = this.parts.find((one) => String(one.number) === this.part.value);
    this.along.disabled = !part;
    if (part) this.snapped(stationAt(part.line, Number(this.along.value) / 100), isOver);
  }
}
