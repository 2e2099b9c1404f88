// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Indices for experts. What everybody needs of them stands in the verdicts.

import { GraspIndex, Vocabulary } from "../types";
import { say, sayName } from "../texts";
import { term } from "./glossary";
import { Markup, html } from "./markup";
import { localised, nothing, shortNumber, signedNumber } from "./numbers";
import { folded } from "./parts";
import { regionWords } from "./verdicts";
import { emptyCell, numbers, rowHead, table, valueCell, words } from "./tables";

function heading(group: string): string {
  return sayName("index.group", group, group);
}

/// The word of a group's indices that the glossary explains.
const explained: { [group: string]: string } = { stability: "epsilon", ease: "coordination" };

/// What the indices of a group are for.
function purpose(group: string): Markup {
  const words = sayName("index.purpose", group, "");
  return html`${words}${explained[group] && html` ${term(explained[group])}`}`;
}

const units: { [unit: string]: string } = { "": "", mm2: " mm²", mm3: " mm³", deg: "°" };

function withUnit(text: string, index: GraspIndex): string {
  const unit = units[index.unit];
  return text + (unit === undefined ? " " + index.unit : unit);
}

/// Whole numbers without decimals: counts, and ends of ranges.
function briefly(value: number): string {
  return value === Math.round(value) ? localised(String(value)) : shortNumber(value);
}

function indexCell(index: GraspIndex | undefined): Markup {
  if (!index || index.value === null) return emptyCell();
  return valueCell(index.value, withUnit(briefly(index.value), index));
}

function better(index: GraspIndex): string {
  return index.better === "up" ? say("index.up") : index.better === "down" ? say("index.down") : nothing;
}

function range(index: GraspIndex): string {
  const { lowest, highest } = index;
  if (lowest === null) return highest === null ? nothing : say("index.up_to", { high: briefly(highest) });
  return highest === null ? say("index.from", { low: briefly(lowest) })
    : say("range", { low: briefly(lowest), high: briefly(highest) });
}

function nameOf(index: GraspIndex): string {
  return sayName("index.name", index.key, index.name);
}

/// A remark names regions and joint angles as files do: "middle_distal", "thumb_mp_flexion".
function remarkWords(remark: string, vocabulary: Vocabulary): string {
  return remark.replace(/[a-z]+(_[a-z]+)*/g, (name) => {
    if (vocabulary.regions[name]) return regionWords(name, vocabulary);
    return vocabulary.motions[name] ? vocabulary.motions[name].words : name;
  });
}

/// `lastRemark`: of the row above, not said twice.
function row(index: GraspIndex, lastRemark: string, vocabulary: Vocabulary): Markup {
  return html`<tr data-index="${index.key}">${rowHead(html`<details><summary>${nameOf(index)}</summary><p>${index.definition}.</p>${index.source && html`<p>${say("index.source", { source: index.source })}</p>`}<p>${say("index.key")} <code>${index.key}</code></p></details>${index.remark !== lastRemark && index.remark && html`<span class="range">${remarkWords(index.remark, vocabulary)}</span>`}`)}${indexCell(index)}<td>${range(index)}</td><td>${better(index)}</td></tr>`;
}

/// Groups in the order in which they appear first.
function groupsOf(indices: GraspIndex[]): string[] {
  const groups: string[] = [];
  for (const one of indices) if (groups.indexOf(one.group) < 0) groups.push(one.group);
  return groups;
}

/// A table per group with what it is for; names unfold to definitions.
export function indexSection(indices: GraspIndex[], vocabulary: Vocabulary): Markup | null {
  if (indices.length === 0) return null;
  const tables = groupsOf(indices).map((group) => {
    let remark = "";
    const rows = indices.filter((one) => one.group === group).map((one) => {
      const made = row(one, remark, vocabulary);
      remark = one.remark;
      return made;
    });
    return html`<h4>${heading(group)}</h4>${sayName("index.purpose", group, "") && html`<p>${purpose(group)}</p>`}${table({
      caption: heading(group),
      className: "indices",
      columns: [words(say("index.head.index")), numbers(say("index.head.value")), words(say("index.head.range")), words(say("index.head.better"))],
      rows,
    })}`;
  });
  return folded(say("index.title"), html`<p>${say("index.intro")}</p>
${tables}`);
}

/// The second value less the first, unless that can't be told apart from nothing.
function differenceCell(first: GraspIndex | undefined, second: GraspIndex | undefined): Markup {
  if (!first || !second || first.value === null || second.value === null) return emptyCell();
  const difference = second.value - first.value;
  const most = Math.max(Math.abs(first.value), Math.abs(second.value));
  if (Math.abs(difference) <= first.told_apart * most) return html`<td class="n">${say("index.same")}</td>`;
  return valueCell(difference, withUnit(signedNumber(difference), first));
}

/// A column per product, and of two the difference where there is one to be told apart; nothing for
/// one product or without indices.
export function indexComparison(names: string[], indices: GraspIndex[][]): Markup | null {
  if (names.length < 2) return null;
  const known: { [key: string]: true } = {};
  const all: GraspIndex[] = [];
  for (const product of indices) {
    for (const one of product) {
      if (known[one.key]) continue;
      known[one.key] = true;
      all.push(one);
    }
  }
  if (all.length === 0) return null;
  const areTwo = names.length === 2;
  const rows = groupsOf(all).map((group) => {
    const members = all.filter((one) => one.group === group).map((one) => {
      const found = indices.map((product) => product.filter((other) => other.key === one.key)[0]);
      return html`<tr data-index="${one.key}">${rowHead(nameOf(one))}${found.map(indexCell)}${areTwo && differenceCell(found[0], found[1])}<td>${better(one)}</td></tr>`;
    });
    return html`<tr><th scope="rowgroup" colspan="${names.length + (areTwo ? 3 : 2)}"><strong>${heading(group)}</strong></th></tr>${members}`;
  });
  return table({
    caption: say(areTwo ? "index.comparison.two" : "index.comparison"),
    columns: [words(say("index.head.index")), ...names.map(numbers),
              ...(areTwo ? [numbers(say("index.head.difference"))] : []), words(say("index.head.better"))],
    rows,
  });
}
