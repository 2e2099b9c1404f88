// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node tests/layers/layers.mjs SRC
//
// Holds every #include "palmar/..." and "hands/..." below SRC to the layering:
//   - src/hands may include src/palmar, never the other way;
//   - a module includes only itself and what stands above it in its house's modules.txt;
//   - folders inside a module form no circle. The module's own folder, '.', counts as one. Tests don't: a
//     test may include what stands above its subject.
// layers_test.mjs shows it trees that must fail.
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { pathToFileURL } from "node:url";
import { code_files, module_names, report } from "./source_tree.mjs";

const kHouses = ["palmar", "hands"];  // each may include those before it

/** [{file, line, house, module, folder, to}] of the includes of one house; `to` has house, module and folder. */
function includes_of(src, house) {
  const place = (path) => {
    const [in_house, module, ...rest] = path.split("/");
    return { house: in_house, module, folder: dirname(rest.join("/")) || "." };
  };
  return code_files(join(src, house), src).flatMap((file) =>
    [...readFileSync(join(src, file), "utf8").matchAll(/^#include "((?:palmar|hands)\/[^"]+)"/gm)]
      .map(([line, path]) => ({ file, line, ...place(file), to: place(path) })));
}

/** What breaks the order of houses and modules, and folders that no modules.txt names. */
function against_the_order(src, houses) {
  const rank = new Map(houses.flatMap((house) =>
    module_names(join(src, house, "modules.txt")).map((name, i) => [`${house}/${name}`, i])));
  const found = [];
  for (const house of houses) {
    for (const entry of readdirSync(join(src, house), { withFileTypes: true })) {
      if (entry.isDirectory() && !rank.has(`${house}/${entry.name}`)) {
        found.push(`${house}/${entry.name}: not in ${house}/modules.txt`);
      }
    }
    for (const { file, line, module, to } of includes_of(src, house)) {
      const other = rank.get(`${to.house}/${to.module}`);
      const is_allowed = other !== undefined && (to.house === house
        ? other <= rank.get(`${house}/${module}`)
        : kHouses.indexOf(to.house) < kHouses.indexOf(house));
      if (!is_allowed) found.push(`${file}: ${line}`);
    }
  }
  return found;
}

/** A shortest circle through `start`: [start, ..., start]; undefined if there is none. */
function circle_through(start, arrows) {
  const ways = [[start]];
  const seen = new Set();
  for (const way of ways) {
    for (const next of arrows.get(way.at(-1))?.keys() ?? []) {
      if (next === start) return [...way, start];
      if (!seen.has(next)) {
        seen.add(next);
        ways.push([...way, next]);
      }
    }
  }
  return undefined;
}

/** Circles of folders, each with the includes that make it; of overlapping ones a shortest. */
function folder_circles(src, houses) {
  const modules = new Map();  // module -> folder -> folder that it includes -> "file: line"
  for (const include of houses.flatMap((house) => includes_of(src, house))) {
    const { file, line, house, module, folder, to } = include;
    if (file.endsWith("_test.cpp") || to.house !== house || to.module !== module || to.folder === folder) continue;
    const name = `${house}/${module}`;
    if (!modules.has(name)) modules.set(name, new Map());
    const arrows = modules.get(name);
    if (!arrows.has(folder)) arrows.set(folder, new Map());
    const targets = arrows.get(folder);
    targets.set(to.folder, [...(targets.get(to.folder) ?? []), `${file}: ${line}`]);
  }
  const found = [];
  for (const [name, arrows] of modules) {
    const told = new Set();
    const circles = [...arrows.keys()].map((folder) => circle_through(folder, arrows)).filter(Boolean)
      .sort((a, b) => a.length - b.length);
    for (const circle of circles) {
      if (circle.some((folder) => told.has(folder))) continue;
      circle.forEach((folder) => told.add(folder));
      found.push(`${name}: folders form a circle: ${circle.join(" -> ")}`);
      for (let i = 0; i + 1 < circle.length; ++i) {
        for (const include of arrows.get(circle[i]).get(circle[i + 1])) found.push(`  ${include}`);
      }
    }
  }
  return found;
}

/** What is against the layering below `src`, a line each; empty if nothing is. */
export function layering_faults(src) {
  const houses = kHouses.filter((house) => existsSync(join(src, house, "modules.txt")));
  if (houses.length === 0) throw new Error(`No modules.txt was found in a folder of ${src}`);
  return [...against_the_order(src, houses), ...folder_circles(src, houses)];
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const src = process.argv[2];
  const count = kHouses.flatMap((house) => code_files(join(src, house), src)).length;
  report(layering_faults(src), "Against the layering", `${count} files respect the layering`);
}
