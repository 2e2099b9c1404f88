// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The elements of the bench's page and what they call; what they show is up to the view.
import { el, fill } from "./dom";
import { people, personWords } from "./people";
import { say } from "./say";

export const kUsualShown = 107; // N; what the slider shows until the server says what the usual force is
const kMostForce = 250; // N


export interface BenchActions {
  back(): void;
  step(which: "undo" | "redo"): void;
  chooseHolder(): void;
  force(newtons: number | null): void;
  setMode(mode: "translate" | "rotate"): void;
  act(what: "close" | "rest"): void;
  again(): void;
  saveProject(): void;
}

export function benchElements(actions: BenchActions) {
  const els = {
    holds: el("ol", { class: "holds" }),
    verdict: el("div", { class: "verdict", role: "status" }),
    status: el("p", { class: "status", role: "status" }),
    point: el("p", { class: "point" }, say("bench.hint")),
    bar: el("div", { class: "view-bar" }),
    command: el("div", { class: "command" }),
    undo: el("button", { type: "button", disabled: true, onclick: () => actions.step("undo") }, say("bench.undo")),
    redo: el("button", { type: "button", disabled: true, onclick: () => actions.step("redo") }, say("bench.redo")),
    person: el("select", { "aria-label": say("bench.who"), onchange: () => actions.chooseHolder() }),
    side: el("select", { "aria-label": `${say("bench.right")}, ${say("bench.left")}`, onchange: () => actions.chooseHolder() }),
    force: el("input", { type: "range", min: 5, max: kMostForce, step: 1, value: kUsualShown, "aria-label": `${say("bench.force")}, N` }),
    forceNumber: el("input", { type: "number", min: 1, max: 1000, step: 1, "aria-label": `${say("bench.force")}, N` }),
    usual: el("input", { type: "checkbox", checked: true }),
    busy: el("div", { class: "busy", hidden: true }),
    lost: el("p", { class: "lost", role: "alert", hidden: true }, say("bench.lost")),
    unkept: el("p", { class: "lost", role: "alert", hidden: true }),
    kept: el("span", { class: "soft kept", role: "status" }),
    hint: el("p", { class: "soft" }, say("bench.place_hint")),
    title: el("div", { class: "title" }),
  };
  fill(els.person, people.map((person) => el("option", { value: person }, personWords(person))));
  fill(els.side, el("option", { value: "right" }, say("bench.right")), el("option", { value: "left" }, say("bench.left")));
  const forceChanged = (from: HTMLInputElement) => () => {
    els.usual.checked = false;
    actions.force(Number(from.value));
  };
  els.force.addEventListener("input", forceChanged(els.force));
  els.forceNumber.addEventListener("change", forceChanged(els.forceNumber));
  els.usual.addEventListener("change", () => actions.force(els.usual.checked ? null : Number(els.force.value)));
  return els;
}

export type BenchElements = ReturnType<typeof benchElements>;

/// Parts that have a class of their own.
export interface BenchParts {
  totals: HTMLElement;
  regions: HTMLElement;
  place: HTMLElement;
  snap: HTMLElement;
  joints: HTMLElement;
  steps: HTMLElement;
}

/// Puts all of it into `root`; gives back the section in which the scene is drawn.
export function benchPage(root: HTMLElement, els: BenchElements, actions: BenchActions, parts: BenchParts): HTMLElement {
  const look = (name: "palm" | "back" | "thumb" | "little") =>
    el("button", { type: "button", "data-look": name }, say(`bench.look_${name}`));
  const mode = (name: "translate" | "rotate", key: "bench.move" | "bench.turn") => el("button", {
    type: "button", "data-mode": name, "aria-pressed": name === "translate" ? "true" : "false",
    onclick: () => actions.setMode(name),
  }, say(key));
  const section = el("section", { class: "bench", "aria-label": say("bench.view") },
    el("aside", { class: "left" }, el("h2", {}, say("bench.who")), el("div", { class: "who" }, els.person, els.side),
      el("h2", {}, say("bench.holds")), els.holds),
    el("div", { class: "middle" },
      el("div", { class: "tools" },
        el("span", { class: "group", role: "group", "aria-label": say("bench.look") }, el("span", { class: "soft" }, say("bench.look")), look("palm"), look("back"), look("thumb"), look("little")),
        el("label", {}, say("bench.product"), el("select", { "data-product": true },
          el("option", { value: "clear" }, say("bench.clear")), el("option", { value: "solid" }, say("bench.solid")), el("option", { value: "hidden" }, say("bench.hidden")), el("option", { value: "alone" }, say("bench.alone")))),
        el("label", {}, say("bench.cut"), el("input", { type: "range", "data-cut": true, min: 0, max: 100, value: 100 })),
        el("button", { type: "button", "data-save": "palmar-bench" }, say("bench.picture"))),
      el("div", { class: "view" }, el("div", { class: "view-canvas", "data-label": say("bench.view") }), els.bar, els.busy), parts.steps, els.status, els.point),
    el("aside", { class: "right" }, els.verdict, parts.totals,
      el("h2", {}, say("bench.force")),
      el("div", { class: "force" }, els.force, el("label", {}, els.forceNumber, "N"), el("label", { class: "usual" }, els.usual, say("bench.usual_force"))),
      el("h2", {}, say("bench.place")),
      el("div", { class: "buttons" }, el("span", { class: "group", role: "group" }, mode("translate", "bench.move"), mode("rotate", "bench.turn")),
        el("button", { type: "button", "data-act": "close", onclick: () => actions.act("close") }, say("bench.close")),
        el("button", { type: "button", "data-act": "rest", onclick: () => actions.act("rest") }, say("bench.rest")),
        el("button", { type: "button", "data-act": "again", onclick: () => actions.again() }, say("bench.again"))),
      parts.place, parts.snap, els.hint,
      el("details", { class: "part", open: true }, el("summary", {}, el("h2", {}, say("bench.regions"))), parts.regions),
      el("details", { class: "part" }, el("summary", {}, el("h2", {}, say("bench.joints"))), parts.joints),
      el("details", { class: "part" }, el("summary", {}, el("h2", {}, say("bench.command"))), els.command)));
  fill(root, el("header", { class: "top" }, el("button", { type: "button", onclick: () => actions.back() }, say("bench.back")), els.title,
    els.kept, el("span", { class: "group" }, els.undo, els.redo, el("button", { type: "button", "data-project": true, onclick: () => actions.saveProject() }, say("bench.save")))), els.lost, els.unkept, section);
  return section;
}
