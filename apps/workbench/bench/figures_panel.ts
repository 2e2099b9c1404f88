// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What the contact comes to: totals, and one row per region in contact. Changes with every frame.
import { el, fill } from "./dom";
import { info } from "./info";
import { FieldFrame } from "./live_frame";
import { decimal, say } from "./say";

const kKpa = 1000; // per MPa

export interface RegionName {
  name: string;
  words: string;
}

export class FiguresPanel {
  private readonly values: Record<string, HTMLElement> = {};
  private readonly rows = el("tbody");
  private shown: { row: HTMLTableRowElement; cells: HTMLElement[] }[] = [];
  readonly totals: HTMLElement;
  readonly table: HTMLElement;
  regions: RegionName[] = [];

  constructor() {
    const line = (key: "grip_force" | "contact_force" | "area" | "peak" | "mean") => {
      const value = el("dd", { "data-figure": key });
      this.values[key] = value;
      return el("div", {}, el("dt", {}, say(`bench.${key}`), " ", info(key)), value);
    };
    this.totals = el("dl", { class: "totals" }, line("grip_force"), line("contact_force"), line("area"), line("peak"), line("mean"));
    this.table = el("table", {}, el("caption", { class: "unseen" }, say("bench.regions")),
      el("thead", {}, el("tr", {}, el("th", { scope: "col" }, say("bench.region")),
        (["bench.force_head", "bench.area_head", "bench.peak_head"] as const).map((key) => el("th", { scope: "col", class: "n" }, say(key))))),
      this.rows);
  }

  show(frame: FieldFrame): void {
    const { total } = frame;
    const set = (key: string, text: string) => {
      if (this.values[key].textContent !== text) this.values[key].textContent = text;
    };
    set("grip_force", `${decimal(frame.gripForce, 1)} N`);
    set("contact_force", `${decimal(total.force, 1)} N`);
    set("area", `${decimal(total.area, 0)} mm²`);
    set("peak", `${decimal(kKpa * total.peakCells, 1)} kPa`);
    set("mean", `${decimal(kKpa * total.mean, 1)} kPa`);
    this.showRows(frame);
  }

  // Rows stay and change their texts: thirty times a second.
  private showRows(frame: FieldFrame): void {
    const count = Math.max(1, frame.regions.length);
    while (this.shown.length < count) {
      const cells = [el("th", { scope: "row" }), el("td", { class: "n" }), el("td", { class: "n" }), el("td", { class: "n" })];
      this.shown.push({ row: el("tr", {}, cells), cells });
    }
    if (this.rows.childElementCount !== count) fill(this.rows, this.shown.slice(0, count).map((one) => one.row));
    for (let k = 0; k < count; ++k) {
      const region = frame.regions[k];
      const name = region ? this.regions[region.region] : undefined;
      const texts = region
        ? [name?.words ?? "", decimal(region.force, 1), decimal(region.area, 0), decimal(kKpa * region.peakCells, 0)]
        : [say("bench.nothing_touched"), "", "", ""];
      this.shown[k].row.dataset.region = name?.name ?? "";
      texts.forEach((text, c) => {
        if (this.shown[k].cells[c].textContent !== text) this.shown[k].cells[c].textContent = text;
      });
    }
  }
}
