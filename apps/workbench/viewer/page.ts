// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What a page does beside its 3-D views: opens the section that a link leads to and all sections for
// printing, copies commands, closes an explanation. Without it everything can still be read.

import { showMetricUnits, showUsUnits } from "./units";

const sections = () => document.querySelectorAll<HTMLDetailsElement>("details");

function openTarget(): void {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  for (let one: Element | null = target; one; one = one.parentElement) {
    if (one instanceof HTMLDetailsElement) one.open = true;
  }
  target?.scrollIntoView();
}

let closed: HTMLDetailsElement[] = [];
window.addEventListener("beforeprint", () => {
  closed = [...sections()].filter((one) => !one.open);
  for (const one of closed) one.open = true;
});
window.addEventListener("afterprint", () => {
  for (const one of closed) one.open = false;
});

// "#print=answer,a4" or "#print=all,letter": what is printed, on which paper.
const printing = /^#print=(answer|all),(a4|letter)$/.exec(location.hash);
if (printing) {
  document.body.classList.toggle("only-answer", printing[1] === "answer");
  const paper = document.createElement("style");
  paper.textContent = `@page{size:${printing[2] === "a4" ? "A4" : "letter"}}`;
  document.head.append(paper);
  for (const one of sections()) one.open = true;
}

// "#slide=answer", "hold", "map": one picture of 1920 x 1080; the first screen is made for 1280 x 720.
const slide = /^#slide=(answer|hold|map)$/.exec(location.hash);
if (slide) {
  document.body.classList.add("only-answer", "slide");
  const names = slide[1] === "hold" ? ["grasp_palm", "hold"] : ["map_open_hand", "mean_hand"];
  const shown = [...document.querySelectorAll<HTMLElement>("figure[data-picture]")]
    .filter((one) => names.includes(one.dataset.picture ?? ""));
  const body = document.querySelector(".answer-body");
  if (slide[1] !== "answer" && body) {
    body.className = "slide-pictures";
    body.replaceChildren(...shown);
    document.querySelector("#answer .next")?.remove();
  }
}

// Inches and pounds, at will.
const unitsButton = document.querySelector<HTMLButtonElement>("button.units");
if (unitsButton) {
  const button = unitsButton;
  let isUs = false;
  const show = (us: boolean): void => {
    isUs = us;
    if (us) showUsUnits(document.documentElement.lang === "de");
    else showMetricUnits();
    button.textContent = (us ? button.dataset.metric : button.dataset.us) ?? "";
  };
  button.hidden = false;
  button.addEventListener("click", () => show(!isUs));
  show(document.body.dataset.units === "us");
}

window.addEventListener("hashchange", openTarget);
if (location.hash && !printing && !slide) openTarget();
// A link to where one is already changes no hash.
document.addEventListener("click", (event) => {
  const link = (event.target as Element).closest?.("a[href^='#']");
  if (link && link.getAttribute("href") === location.hash) openTarget();
});

for (const button of document.querySelectorAll<HTMLButtonElement>("button[data-copy]")) {
  button.hidden = false;
  button.addEventListener("click", () => {
    void navigator.clipboard?.writeText(button.dataset.copy ?? "");
    button.classList.add("done");
  });
}

// An explanation stands beside its word.
for (const entry of document.querySelectorAll<HTMLElement>("[popover]")) {
  entry.addEventListener("toggle", () => {
    const word = document.querySelector(`[popovertarget="${entry.id}"]:focus`) ?? document.activeElement;
    const box = word?.getBoundingClientRect();
    if (!box) return;
    entry.style.left = `${Math.max(8, Math.min(box.left, innerWidth - entry.offsetWidth - 8))}px`;
    entry.style.top = `${Math.min(box.bottom + 6, innerHeight - entry.offsetHeight - 8)}px`;
  });
}

// The workbench, in whose frame this page may stand, asks for one hand with one product in the 3-D view.
window.addEventListener("message", (event: MessageEvent<unknown>) => {
  if (event.source !== window.parent || window.parent === window) return;
  const asked = event.data as { palmar?: string; product?: number; hand?: number } | null;
  const view = document.getElementById("turn");
  if (asked?.palmar !== "show-hand" || !view) return;
  const choose = (name: string, value: unknown): void => {
    const select = view.querySelector<HTMLSelectElement>(`[data-toggle="${name}"]`);
    const option = [...(select?.options ?? [])].find((one) => one.value === String(value));
    if (!select || !option) return;
    select.value = option.value;
    select.dispatchEvent(new Event("change"));
  };
  for (let one: Element | null = view; one; one = one.parentElement) {
    if (one instanceof HTMLDetailsElement) one.open = true;
  }
  for (const one of view.querySelectorAll("details")) one.open = true;
  choose("which-product", asked.product);
  choose("which-hand", asked.hand);
  (view.querySelector(".view-canvas") ?? view).scrollIntoView({ block: "center" });
});
