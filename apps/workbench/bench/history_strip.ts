// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The steps of the bench as small pictures; one click goes back, or forward, to any of them.
import { el, fill } from "./dom";
import { say } from "./say";

export class HistoryStrip {
  readonly element = el("ol", { class: "steps", "aria-label": say("bench.steps"), hidden: true });

  constructor(private readonly goTo: (index: number) => void) {}

  show(pictures: string[], at: number): void {
    this.element.hidden = pictures.length < 2;
    fill(this.element, pictures.map((picture, k) => el("li", {}, el("button", {
      type: "button", "data-step": k, "aria-current": k === at ? "step" : null, title: say("bench.step", { number: k + 1 }),
      "aria-label": say("bench.step", { number: k + 1 }), onclick: () => this.goTo(k),
    }, picture ? el("img", { src: picture, alt: "", width: 72, height: 46 }) : String(k + 1)))));
    this.element.querySelector("[aria-current]")?.scrollIntoView({ block: "nearest", inline: "nearest" });
  }
}
