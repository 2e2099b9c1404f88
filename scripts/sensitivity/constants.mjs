// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The constants of the sources that a hold rests on, and the same sources with constants that can be changed
// while the program runs. Read by scripts/sensitivity.mjs and tests/sensitivity/sensitivity_test.mjs.
import { createHash } from "node:crypto";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";

/** Folders of src/palmar whose constants are named, and what is done anew when one of them changes. */
export const kFolders = [
  { folder: "grasp/equilibrium", anew: "rest" },
  { folder: "hand/tendons", anew: "rest" },
  { folder: "contact/bone", anew: "compliance" },
  { folder: "contact", anew: "prepared" },
  { folder: "grasp/power", anew: "closed" },
  { folder: "grasp/precision", anew: "fingertips" },
  // What is asked of a hold, and what is said of it.
  { folder: "grasp/rest", anew: "rest", only: /\/balance\.h$/ },
  { folder: "grasp/rest", anew: "searched" },
  { folder: "grasp", anew: "closed", only: /^grasp\/\w+\.(h|cpp)$/ },
  // Where a hold lies on a product: the hand is closed by that.
  { folder: "grasp/holds", anew: "closed", only: /\/(hold_place|power_place)\.(h|cpp)$/ },
  { folder: "grasp/holds", anew: "ranked" },
  { folder: "grasp/find", anew: "ranked" },
];

/**
 * Constants that say how a search goes on, how it is damped, where it begins to look and when it ends, but not what it looks
 * for: what they change is chance (file -> names).
 */
const kSteering = {
  "grasp/equilibrium/least_effort.cpp":
    /^kOnCoarseSkin\[|^kWithFingertips\[0\]|\.(least_gain|first_damping)$|^k(Accuracy|Step|Arm|BackDamping|UsualSteps|Poor|Worthwhile|LeastShare|Shorter|AsGood|Growth|Kept)$/,
  "grasp/equilibrium/effort_program.cpp": /^kTolerance$/,
  "grasp/equilibrium/contact_forces.cpp": /^kRates$/,
  "grasp/equilibrium/digit_meeting.cpp": /^kStep$/,
  "grasp/equilibrium/skin_motion.h": /^k(ForcePower|AngleStep)$/,
};

/** What nobody can choose otherwise: units, mathematics, and a share of which 5 % more breaks the method (file -> names). */
const kNeverVaried = {
  "contact/bone/half_space_tensor.cpp": /^kBinomial$/,
  "contact/bone/mini_element.cpp": /^kBubble/,
  "contact/response/layered_response.cpp": /^k(Node|Weight|Step|DiedOut)$/,
  "contact/tissue/stiffening.cpp": /^kSlope$/,
  "grasp/equilibrium/effort_program.cpp": /^kToBoundary$/,
  "hand/tendons/tendon.cpp": /^kMm2PerCm2$/,
  "hand/tendons/tendon_path.cpp": /^kTurn$/,
};

/**
 * Files of those folders that are no part of a hold, its equilibrium or its contact: presses, fits to measured presses, the thesis'
 * procedure, maps, what is done once a hold is at rest (refined skin, the margin of friction, what is told of edges), postures that
 * are given, buttons within reach, what a person can and a task asks for, holds carried to another product, effort of a posture.
 */
const kElsewhere = new RegExp("^contact/(press/|printed/|refine/|footprint/|tissue/tissue_fit|tissue/modulus_search|hand/hand_press|prepared/resolution|" +
  "friction/(friction|friction_limit|stick_slip)\\.)|^grasp/(joint_strength|pressure_thresholds|task_force|given_grasp|precision/reach|holds/carried_hold|" +
  "rest/(usual_task|friction_settings|rest_settings))|^hand/tendons/muscle_balance");
/** Structs with settings or figures of a model as their members' defaults. */
const kStructs = /\w+(?:Model|Options)$/;
/** Lists whose numbers have a meaning each; all other lists are changed as a whole. */
const kByMember = /^(?:Descent|Stage)$/;
const kNumber = /(?<![\w.])(?:\d+\.\d*|\.\d+|\d+(?=e))(?:e[-+]?\d+)?F?(?![\w.])/gi;

export const id_of = (file, name) => `0x${createHash("sha256").update(`${file}:${name}`).digest("hex").slice(0, 15)}ULL`;

/** How a constant's effect is found, by its file and name; undefined: not at all. */
export function anew_for(file, name = "") {
  if (kElsewhere.test(file) || /_test\.|_test_/.test(file)) return undefined;
  if (kNeverVaried[file]?.test(name)) return "never";
  if (kSteering[file]?.test(name)) return "steering";
  return kFolders.find(({ folder, only }) => file.startsWith(`${folder}/`) && (only?.test(file) ?? true))?.anew;
}

function files_below(folder) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) =>
    entry.isDirectory() ? files_below(join(folder, entry.name)) : [join(folder, entry.name)]);
}

/** Every source whose constants are named, as a path below src/palmar. */
export function source_files(root) {
  const src = join(root, "src", "palmar");
  return ["grasp", "contact", "hand/tendons"].flatMap((folder) => files_below(join(src, folder)))
    .map((file) => file.slice(src.length + 1).replaceAll("\\", "/"))
    .filter((file) => /\.(h|cpp)$/.test(file) && anew_for(file)).sort();
}

/** Parts between commas that stand in no bracket. */
function parts_of(text) {
  const parts = [""];
  let depth = 0;
  for (const c of text) {
    if ("([{".includes(c)) ++depth;
    if (")]}".includes(c)) --depth;
    if (c === "," && depth === 0) parts.push("");
    else parts[parts.length - 1] += c;
  }
  return parts.filter((part) => part.trim());
}

const in_one_line = (text) => text.replace(/\/\/[^\n]*/g, " ").replace(/\s+/g, " ").trim();

/** What stands beside a statement, else in the comment right above it. */
function words_at(text, begin, end) {
  // Goes on in lines that begin far to the right.
  const beside = /^[ \t]*\/\/+<?([^\n]*(?:\n[ \t]{12,}\/\/\/?<?(?!\/)[^\n]*)*)/.exec(text.slice(end));
  const above = /((?:^[ \t]*\/\/[^\n]*\n)+)$/m.exec(text.slice(0, begin));
  const said = beside ? beside[1] : above && text.slice(0, begin).endsWith(above[1]) ? above[1] : "";
  return said.split("\n").map((line) => line.replace(/^\s*\/\/+<?\s?/, "").trim()).join(" ").trim();
}

/** Names of the members of a struct of the same file, in their order. */
function members_of(text, type) {
  const body = new RegExp(`struct ${type} \\{([\\s\\S]*?)\\n\\};`).exec(text)?.[1] ?? "";
  return [...body.replace(/\/\/[^\n]*/g, "").matchAll(/^\s*(?:double|int|float) (\w+)[^;]*;/gm)].map(([, name]) => name);
}

/** A list with each member's number as varied(); tells `found` of each. Lists of lists are numbered. */
function by_member(list, members, name, file, found) {
  const inner = list.trim().replace(/^=?\s*\{([\s\S]*)\}$/, "$1");
  const parts = parts_of(inner);
  if (parts.some((part) => part.trim().startsWith("{"))) {
    return `{${parts.map((part, k) => by_member(part, members, parts.length > 1 ? `${name}[${k}]` : name, file, found)).join(", ")}}`;
  }
  return `{${parts.map((part, k) => {
    if (!/[.e]/.test(part) || !members[k] || Number(part) === 0) return part;
    found.push({ name: `${name}.${members[k]}`, value: in_one_line(part) });
    return ` palmar::sensitivity::varied<double>(${id_of(file, `${name}.${members[k]}`)}, ${part.trim()})`;
  }).join(",")}}`;
}

/**
 * The constants of one source, and its text with those that aren't in `fixed` changeable.
 * `file`: below src/palmar. A constant has file, name, value, words and anew; `is_fixed`: the compiler has to know it.
 */
export function with_changeable_constants(file, text, fixed = new Set()) {
  const constants = [];
  const take = (name, value, words, is_fixed = false) =>
    constants.push({ id: `${file}:${name}`, file, name, value: in_one_line(value), words, anew: anew_for(file, name), is_fixed });
  const statement = /^([ \t]*)((?:inline |static )*)constexpr ((?:std::array(?:<[^=;{]*?>)?|\w+)) (k[A-Z][^;]*);/gm;
  let changed = text.replace(statement, (whole, indent, storage, type, list, at) => {
    const words = words_at(text, at, at + whole.length);
    const parts = parts_of(list).map((part) => /^\s*(k\w+)((?:\s*\[[^\]]*\])*)\s*(?:=\s*([\s\S]+)|(\{[\s\S]*\}))$/.exec(part));
    if (parts.some((part) => !part)) return whole;
    const is_scalar = /^(double|float)$/.test(type);
    const named = type.replace(/^std::array<|,.*$|>$/g, "");
    if (!is_scalar && !/[.]\d|\de-?\d|\d\./.test(in_one_line(list)) && !/^std::array<double/.test(type)) return whole;
    if (/^(int|bool|auto|char|std::size_t|GripRow)$/.test(named)) return whole;
    const is_of_class = indent && /static/.test(storage) && file.endsWith(".h");
    const found = [];
    const made = parts.map(([, name, dimensions, behind, braces]) => {
      const value = behind ?? braces;
      const is_list = dimensions || !is_scalar;
      if (!is_list) {
        found.push({ name, value });
        return { name, dimensions: "", value, now: `${name} = palmar::sensitivity::varied<${type}>(${id_of(file, name)}, ${value});` };
      }
      let now;
      if (kByMember.test(named)) {
        now = by_member(value, members_of(text, named), name, file, found);
      } else {
        found.push({ name, value });
        now = value.replace(/\/\/[^\n]*/g, "").replace(kNumber, (number) => `palmar::sensitivity::varied(${id_of(file, name)}, ${number})`);
        if (/double/.test(type)) {
          now = now.replace(/(?<=[{,]\s*)-?\d+(?=\s*[,}])/g, (number) => `palmar::sensitivity::varied(${id_of(file, name)}, ${number}.0)`);
        }
      }
      return { name, dimensions, value: (behind ? "= " : "") + value,
               now: `{ ${type} now${dimensions}${behind ? " = " : ""}${now}; palmar::sensitivity::assign(${name}, now); }` };
    });
    const is_fixed = is_of_class || parts.some(([, name]) => fixed.has(`${file}:${name}`));
    for (const { name, value } of found) take(name, value, words, is_fixed);
    if (is_fixed) return whole;
    const kind = file.endsWith(".h") && !indent ? "inline" : "static";
    return made.map(({ name, dimensions, value, now }) =>
      `${indent}${kind} ${type} ${name}${dimensions} ${value.startsWith("=") || value.startsWith("{") ? value : `= ${value}`};` +
      ` [[maybe_unused]] ${kind} const bool ${name}_is_set = palmar::sensitivity::add([] { ${now} });`).join("\n");
  });
  if (file.endsWith(".h")) {
    changed = changed.replace(/^struct (\w+)(?: :[^{;]*)? \{\n([\s\S]*?)^\};/gm, (whole, type, body) => {
      if (!kStructs.test(type)) return whole;
      const made = body.replace(/^  double ([^;(]*);/gm, (line, list, at) => {
        const words = words_at(body, at, at + line.length);
        return `  double ${parts_of(list).map((part) => {
          const [, name, value] = /^\s*(\w+)(?:\s*=\s*([\s\S]+))?$/.exec(part) ?? [];
          // One that has the value of a constant goes with that.
          if (!value || Number(value) === 0 || /^k[A-Z]\w*$/.test(value.trim())) return part;
          const is_fixed = fixed.has(`${file}:${type}.${name}`);
          take(`${type}.${name}`, value, words, is_fixed);
          return is_fixed ? part : `${name} = palmar::sensitivity::varied<double>(${id_of(file, `${type}.${name}`)}, ${value})`;
        }).join(", ")};`;
      });
      return whole.replace(body, () => made);
    });
  }
  if (constants.some((one) => !one.is_fixed)) {
    changed = changed.replace(/^(#include |#pragma once)/m, (line) =>
      line.startsWith("#pragma") ? `${line}\n#include "palmar/core/varied.h"` : `#include "palmar/core/varied.h"\n${line}`);
  }
  return { constants, text: changed };
}

/** All constants of a checkout. */
export function constants_of(root) {
  return source_files(root).flatMap((file) =>
    with_changeable_constants(file, readFileSync(join(root, "src", "palmar", file), "utf8")).constants);
}
