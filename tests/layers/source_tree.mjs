// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What the checks of this folder read: modules.txt and the sources.
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { join, relative, sep } from "node:path";

/** Paths of the headers and sources below a folder, from `from`, sorted. */
export function code_files(folder, from) {
  if (!existsSync(folder)) return [];
  return readdirSync(folder, { withFileTypes: true })
    .flatMap((entry) => {
      const path = join(folder, entry.name);
      if (entry.isDirectory()) return entry.name === "node_modules" ? [] : code_files(path, from);
      return /\.(h|cpp)$/.test(entry.name) ? [relative(from, path).split(sep).join("/")] : [];
    })
    .sort();
}

/** The names in a modules.txt, bottom to top: lines like "core: what it is". */
export function module_names(file) {
  const names = readFileSync(file, "utf8").split("\n")
    .map((line) => /^([a-z_]+):/.exec(line)?.[1]).filter(Boolean);
  if (names.length === 0) throw new Error(`${file} names no module; lines like "core: what it is" are required`);
  return names;
}

/** Prints what was found and sets the exit code; says how much was read if nothing was. */
export function report(findings, heading, fine) {
  if (findings.length > 0) {
    console.error(`${heading}:\n${findings.join("\n")}`);
    process.exitCode = 1;
  } else {
    console.log(fine);
  }
}
