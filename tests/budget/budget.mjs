// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node tests/budget/budget.mjs ROOT BUILD [--write]
//
// Holds the house to docs/developing/budget.toml: production lines per module, constants without a source,
// megabytes of the programs, and what a clean build costs to compile. Prints what is exceeded and ends with 1;
// --write prints the present figures as such a file instead.
//
// Compiling (of Palmar's house, which ./check builds) is measured in units of one source, cmake/precompiled/eigen_orthogonal.cpp of the same build, so that
// it means the same on a slow machine. Durations come from Ninja's log; a build in which that source is missing
// isn't judged.
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const code = /\.(h|cpp)$/;
const test = /_test\.(h|cpp)$|\/tests\//;

function filesBelow(folder) {
  if (!fs.existsSync(folder)) return [];
  return fs.readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const file = path.join(folder, entry.name);
    return entry.isDirectory() ? filesBelow(file) : [file];
  });
}

/// Production sources: path in the checkout, module ("palmar/contact", "apps/palmar"), text.
export function sources(root) {
  const list = [];
  for (const top of ['src/palmar', 'src/hands', 'apps', 'python/native']) {
    for (const file of filesBelow(path.join(root, top))) {
      const name = path.relative(root, file);
      if (!code.test(name) || test.test(name)) continue;
      const parts = name.split('/');
      const module = top === 'python/native' ? 'python' : (top === 'apps' ? 'apps/' + parts[1] : parts[1] + '/' + parts[2]);
      list.push({ name, module, text: fs.readFileSync(file, 'utf8') });
    }
  }
  return list;
}

const constant = /^\s*(?:inline |static )*constexpr (?:double|float|int|std::size_t|auto) k[A-Z]\w*\b[^(]*=/;
const sourced = /[Ss]ource|\b(?:19|20)\d\d\b|\beq\.|\bISO\b|\bunit\b|\boption/;

/// Constants that name no source: neither in their own line nor in the comment that ends right above it.
export function unsourcedConstants(text) {
  const lines = text.split('\n');
  return lines.filter((line, at) => {
    if (!constant.test(line)) return false;
    let said = line;
    for (let above = at - 1; above >= 0 && /^\s*\/\//.test(lines[above]); above -= 1) said += lines[above];
    return !sourced.test(said);
  }).length;
}

/// Milliseconds that each output of a build took, the last time it was made.
export function durations(log) {
  const last = new Map();
  for (const line of log.split('\n').slice(1)) {
    const [begin, end, , output] = line.split('\t');
    if (output) last.set(output, Number(end) - Number(begin));
  }
  return last;
}

/// What compiling cost, in units of the reference source; nothing where the log doesn't know that.
export function compileUnits(log) {
  let all = 0, reference = 0;
  for (const [output, time] of durations(log)) {
    if (!/\.(o|pch|gch)$/.test(output) || /(^|\/)hands\/|palmar-(hands|photo|dicom)/.test(output)) continue;
    all += time;
    if (output.includes('eigen_orthogonal')) reference = time;
  }
  return reference > 0 ? all / reference : undefined;
}

export function measure(root, build) {
  const figures = { lines: {}, constants: {}, megabytes: {}, compile: {} };
  for (const { module, text } of sources(root)) {
    figures.lines[module] = (figures.lines[module] ?? 0) + text.split('\n').length - 1;
    figures.constants[module] = (figures.constants[module] ?? 0) + unsourcedConstants(text);
  }
  for (const name of ['palmar', 'palmar-hands', 'palmar-redesign', 'palmar-serve', 'palmar-cad']) {
    const file = path.join(build, 'bin', name);
    if (fs.existsSync(file)) figures.megabytes[name] = Math.ceil(fs.statSync(file).size / 1e6);
  }
  const log = path.join(build, '.ninja_log');
  const units = fs.existsSync(log) ? compileUnits(fs.readFileSync(log, 'utf8')) : undefined;
  if (units !== undefined) figures.compile.clean_build = Math.round(units);
  return figures;
}

/// [section] and `name = { start = N, most = N, reason = "..." }`, all that such a file has.
export function readBudget(text, file) {
  const budget = {};
  let section = '';
  text.split('\n').forEach((line, at) => {
    if (/^\s*(#|$)/.test(line)) return;
    const head = /^\[(\w+)\]$/.exec(line);
    const entry = /^"?([\w/-]+)"? = \{ start = (\d+), most = (\d+)(?:, reason = "([^"]*)")? \}$/.exec(line);
    if (head) budget[section = head[1]] = {};
    else if (entry && section) budget[section][entry[1]] = { start: +entry[2], most: +entry[3], reason: entry[4] ?? '', at: at + 1 };
    else throw new Error(`${file}:${at + 1}: "${line}"; [section] or name = { start = N, most = N, reason = "..." } is allowed`);
  });
  return budget;
}

/// What is exceeded, lacks a reason, or stands on one side only; a line each.
export function complaints(figures, budget, file) {
  const said = [];
  for (const [section, entries] of Object.entries(figures)) {
    for (const [name, value] of Object.entries(entries)) {
      const entry = budget[section]?.[name];
      if (!entry) said.push(`${file}: ${section} of ${name} (${value}) has no entry in [${section}]`);
      else if (value > entry.most) said.push(`${file}:${entry.at}: ${section} of ${name}: ${value}; at most ${entry.most} are allowed`);
    }
  }
  for (const [section, entries] of Object.entries(budget)) {
    for (const [name, entry] of Object.entries(entries)) {
      if (entry.most > entry.start && !entry.reason) said.push(`${file}:${entry.at}: ${section} of ${name} was raised from ${entry.start} to ${entry.most} without a reason`);
      if ((section === 'lines' || section === 'constants') && figures[section]?.[name] === undefined) said.push(`${file}:${entry.at}: ${name} is no module (any more)`);
    }
  }
  return said;
}

/// The present figures as a budget, with a little room: 2 % of lines, a quarter of what compiling costs.
function written(figures) {
  const room = { lines: (n) => Math.ceil(n * 1.02 / 10) * 10, constants: (n) => n, megabytes: (n) => n + 1, compile: (n) => Math.ceil(n * 1.25) };
  return Object.entries(figures).map(([section, entries]) => `[${section}]\n` + Object.keys(entries).sort().map((name) => {
    const most = room[section](entries[name]);
    return `"${name}" = { start = ${most}, most = ${most} }\n`;
  }).join('')).join('\n');
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  const [root, build, option] = process.argv.slice(2);
  if (!root || !build) {
    console.error('usage: node tests/budget/budget.mjs ROOT BUILD [--write]');
    process.exit(2);
  }
  const figures = measure(root, build);
  if (option === '--write') {
    process.stdout.write(written(figures));
  } else {
    const file = 'docs/developing/budget.toml';
    const said = complaints(figures, readBudget(fs.readFileSync(path.join(root, file), 'utf8'), file), file);
    for (const line of said) console.error(line);
    const sum = (entries) => Object.values(entries).reduce((a, b) => a + b, 0);
    console.log(`${sum(figures.lines)} production lines, ${sum(figures.constants)} constants without a source, ` +
      `${sum(figures.megabytes)} MB of programs, ${figures.compile.clean_build ?? 'unknown'} units of compiling`);
    process.exit(said.length > 0 ? 1 : 0);
  }
}
