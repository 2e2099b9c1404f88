// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The tables of docs/using that say what a file holds, and whether a file holds just that.
//
// A table has the columns field, unit, type and range, meaning. "<!-- format NAME -->" before it says whose it is,
// "<!-- format NAME, as ONE and OTHER -->" that the fields of these are its, too; "Below `path`:" that its fields
// stand there. A field is a path: `regions[]` are the elements of a list, a word in capitals is a name that is data
// (`posture.ANGLE_deg`). Types are checked as their words say: number, whole number, text, true or false, list, list
// of 3 numbers, object; `one`, `of`, `these` words; "optional", "or null", "or empty"; "0 to 1", "at least 0", "above
// 0". A link to a shape ([placement](#placement)) stands for that shape's fields.
import {readFileSync} from "node:fs";

const newNode = () => ({children: new Map(), patterns: [], items: null, row: null});

/** "a[].b" as ["a", "[]", "b"]. */
const stepsOf = (path) => path.split(".").flatMap((one) => {
  const lists = one.match(/(\[\])*$/)[0].length / 2;
  const name = one.slice(0, one.length - 2 * lists);
  return [...(name ? [name] : []), ...Array(lists).fill("[]")];
});

function nodeAt(root, path) {
  let node = root;
  for (const step of path ? stepsOf(path) : []) {
    if (step === "[]") {
      node = node.items ??= newNode();
    } else if (/[A-Z]{3,}/.test(step)) {
      let found = node.patterns.find((one) => one.text === step);
      if (!found) {
        const pattern = new RegExp(`^${step.replace(/[A-Z]{3,}/g, "(?:.+)")}$`, "s");
        node.patterns.push(found = {text: step, pattern, node: newNode()});
      }
      node = found.node;
    } else {
      if (!node.children.has(step)) node.children.set(step, newNode());
      node = node.children.get(step);
    }
  }
  return node;
}

/** What the third column says. */
function typeOf(words, where) {
  const plain = words.replace(/`[^`]*`/g, "").replace(/\[([^\]]*)\]\([^)]*\)/g, "");
  const type = {
    isOptional: /\boptional\b/.test(plain), mayBeNull: /\bor null\b/.test(plain), mayBeEmpty: /\bor empty\b/.test(plain),
    words: [...words.matchAll(/`([^`]*)`/g)].map(([, one]) => one),
    shape: words.match(/\[[^\]]*\]\([^)#]*#([a-z0-9-]+)\)/)?.[1], isListOfShape: /\blist of \[/.test(words),
  };
  const count = plain.match(/\blist of (\d+) numbers\b/);
  if (count) Object.assign(type, {kind: "numbers", count: Number(count[1])});
  else if (/\blist of numbers\b/.test(plain)) type.kind = "numbers";
  else if (/\blist of texts\b/.test(plain)) type.kind = "texts";
  else if (/\blist\b/.test(plain)) type.kind = "list";
  else if (/\bobject\b|\btable\b/.test(plain)) type.kind = "object";
  else if (/\bwhole number\b/.test(plain)) type.kind = "whole";
  else if (/\bnumber\b/.test(plain)) type.kind = "number";
  else if (/\btrue or false\b/.test(plain)) type.kind = "boolean";
  else if (/\btext\b/.test(plain) || type.words.length > 0) type.kind = "text";
  else if (type.shape) type.kind = type.isListOfShape ? "list" : "object";
  else throw new Error(`${where}: "${words}" names no type`);
  const number = "(-?[0-9.]+(?:e[0-9]+)?)";
  const range = plain.match(new RegExp(`${number} to ${number}`));
  if (range) Object.assign(type, {lowest: Number(range[1]), highest: Number(range[2])});
  const least = plain.match(new RegExp(`at least ${number}`)), above = plain.match(new RegExp(`above ${number}`));
  if (least) type.lowest = Number(least[1]);
  if (above) Object.assign(type, {lowest: Number(above[1]), isLowestOut: true});
  return type;
}

const slugOf = (name) => name.replaceAll(/[^a-z0-9-]/g, "");

/** All formats of these pages: name -> root of its fields. */
export function readFormats(pages) {
  const formats = new Map();
  for (const page of pages) {
    let root = null, base = "", inTable = false;
    readFileSync(page, "utf8").split("\n").forEach((line, i) => {
      const where = `${page}:${i + 1}`;
      const [, format, other] = line.match(/^<!-- format (.*?)(?:, as (.*))? -->$/) ?? [];
      if (format) {
        if (formats.has(format)) throw new Error(`${where}: ${format} stands there twice`);
        formats.set(format, root = newNode());
        root.as = other?.split(" and ") ?? [];
        base = "";
      }
      const below = line.match(/^Below `([^`]+)`/);
      if (below) base = below[1];
      if (/^#/.test(line)) base = "";
      if (/^\| (field|column) \| unit \| type/.test(line)) {
        inTable = true;
        return;
      }
      if (!line.startsWith("|")) inTable = false;
      if (!inTable || /^\|[-|]+$/.test(line)) return;
      if (!root) throw new Error(`${where}: a table of no format`);
      const cells = line.split("|").slice(1, -1).map((one) => one.trim());
      if (cells.length !== 4) throw new Error(`${where}: ${cells.length} cells; 4 are needed`);
      const [fields, unit, type, meaning] = cells;
      if (!meaning) throw new Error(`${where}: no meaning`);
      for (const [, field] of fields.matchAll(/`([^`]+)`/g)) {
        const node = nodeAt(root, base && !field.startsWith("[]") ? `${base}.${field}` : base + field);
        if (node.row) throw new Error(`${where}: ${field} stands there twice`);
        node.row = {where, field: base ? `${base}.${field}` : field, unit, meaning, ...typeOf(type, where)};
        // The unit of a name is that of the table.
        const last = /_per_/.test(field) ? "" : field.replace(/(\[\]|\.[A-Z_]+)+$/, "");
        const named = last.match(/_(mm3|mm2|mm|n_mm|n|mpa|kpa|deg|rad|kg|px)$/)?.[1];
        const told = {n: "N", n_mm: "N mm", mpa: "MPa", kpa: "kPa"}[named] ?? named;
        if (named && told !== unit) throw new Error(`${where}: ${field} is in ${told}, the table says "${unit}"`);
      }
    });
  }
  /** Fields of `from` are fields of `node`, too. */
  const splice = (node, from) => {
    for (const [key, child] of from.children) {
      if (node.children.has(key)) splice(node.children.get(key), child);
      else node.children.set(key, child);
    }
    for (const one of from.patterns) {
      const own = node.patterns.find(({text}) => text === one.text);
      if (own && own !== one) splice(own.node, one.node);
      else if (!own) node.patterns.push(one);
    }
    node.row ??= from.row;
    if (node.items && from.items) splice(node.items, from.items);
    node.items ??= from.items;
  };
  const shapes = new Map([...formats].map(([name, root]) => [slugOf(name), root]));
  const visit = (node) => {
    if (node.row?.shape && !node.isSpliced) {
      const shape = shapes.get(node.row.shape);
      if (!shape) throw new Error(`${node.row.where}: ${node.row.shape} is no shape`);
      node.isSpliced = true;
      splice(node.row.isListOfShape ? (node.items ??= newNode()) : node, shape);
    }
    for (const child of node.children.values()) visit(child);
    for (const one of node.patterns) visit(one.node);
    if (node.items) visit(node.items);
  };
  const complete = (root) => {
    for (const other of root.as.splice(0)) {
      complete(formats.get(other));
      splice(root, formats.get(other));
    }
  };
  for (const root of formats.values()) complete(root);
  for (const root of formats.values()) visit(root);
  return formats;
}

function checkValue(value, row, where, faults) {
  const fault = (why) => faults.push(`${where}: is ${JSON.stringify(value)?.slice(0, 60)}; ${row.where} says ${why}`);
  if (value === null) {
    if (!row.mayBeNull) fault("no null");
    return;
  }
  const isIn = (x) => !(x < row.lowest) && !(x > row.highest) && !(row.isLowestOut && x === row.lowest);
  switch (row.kind) {
    case "number": case "whole":
      if (typeof value !== "number") fault("number");
      else if (row.kind === "whole" && !Number.isInteger(value)) fault("whole number");
      else if (!isIn(value)) fault(`${row.isLowestOut ? "above " : ""}${row.lowest ?? ""} to ${row.highest ?? ""}`);
      break;
    case "boolean":
      if (typeof value !== "boolean") fault("true or false");
      break;
    case "text":
      if (typeof value !== "string") fault("text");
      else if (row.words.length > 0 && !row.words.includes(value)) fault(row.words.join(", "));
      break;
    case "numbers":
      if (!Array.isArray(value) || value.some((one) => typeof one !== "number")) fault("list of numbers");
      else if (row.count !== undefined && value.length !== row.count) fault(`${row.count} numbers`);
      else if (!value.every(isIn)) fault(`${row.lowest} to ${row.highest}`);
      break;
    case "texts":
      if (!Array.isArray(value) || value.some((one) => typeof one !== "string")) fault("list of texts");
      break;
    case "list":
      if (!Array.isArray(value)) fault("list");
      break;
    default:
      if (typeof value !== "object" || Array.isArray(value)) fault("object");
  }
}

/** Adds to `faults` what `value` has and the tables don't say, and the other way round. */
export function check(value, node, where, faults) {
  node.isSeen = true;
  if (node.row) checkValue(value, node.row, where, faults);
  if (value === null || typeof value !== "object") return;
  if (Array.isArray(value)) {
    if (node.items) value.forEach((one, i) => check(one, node.items, `${where}[${i}]`, faults));
    else if (value.some((one) => one !== null && typeof one === "object" && !Array.isArray(one)) || !node.row) {
      faults.push(`${where}: its elements aren't documented`);
    }
    return;
  }
  for (const [key, one] of Object.entries(value)) {
    const child = node.children.get(key) ?? node.patterns.find(({pattern}) => pattern.test(key))?.node;
    if (child) check(one, child, `${where}.${key}`, faults);
    else faults.push(`${where}: "${key}" isn't documented (${JSON.stringify(one)?.slice(0, 60)})`);
  }
  for (const [key, child] of node.children) {
    if (key in value || child.row?.isOptional || child.items?.row?.isOptional) continue;
    faults.push(`${where}: "${key}" is documented and isn't there`);
  }
}

/** Fields that no file had so far. */
export function unseen(node) {
  if (!node.isSeen) return node.row ? [node.row.field] : [];
  const below = [...node.children.values(), ...node.patterns.map((one) => one.node), ...(node.items ? [node.items] : [])];
  return below.flatMap(unseen);
}

/** Cells of a CSV file (RFC 4180) by column; numbers, words and "" as the table says. */
function rowsOfCsv(file, node, where, faults) {
  const text = file.replaceAll(/^#.*\n/gm, "");  // comments, in what people write
  const rows = [];
  let row = [], cell = "", isQuoted = false;
  for (let i = 0; i < text.length; ++i) {
    const c = text[i];
    if (isQuoted) {
      if (c !== '"') cell += c;
      else if (text[i + 1] === '"') cell += text[++i];
      else isQuoted = false;
    } else if (c === '"') {
      isQuoted = true;
    } else if (c === "," || c === "\n") {
      row.push(cell);
      cell = "";
      if (c === "\n") {
        rows.push(row);
        row = [];
      }
    } else if (c !== "\r") {
      cell += c;
    }
  }
  const [header, ...body] = rows;
  const rowOf = (name) => (node.children.get(name) ?? node.patterns.find(({pattern}) => pattern.test(name))?.node)?.row;
  const typed = (text, name) => {
    const one = rowOf(name);
    if (!one) return text;
    if (text === "") return one.kind === "text" && one.words.length === 0 ? "" : one.mayBeEmpty ? undefined : null;
    return one.kind === "number" || one.kind === "whole" ? Number(text) : text;
  };
  for (const cells of body) {
    if (cells.length !== header.length) faults.push(`${where}: a row of ${cells.length} cells below ${header.length}`);
  }
  // A column that is there with empty cells is there.
  const all = body.map((cells) => Object.fromEntries(header.map((name, i) => [name, typed(cells[i], name)])));
  for (const one of all) for (const key of Object.keys(one)) if (one[key] === undefined) one[key] = emptyCell;
  return {header, rows: all};
}

const emptyCell = Symbol("empty");

export function checkCsv(text, node, where, faults) {
  const {header, rows} = rowsOfCsv(text, node, where, faults);
  const seen = (name) => node.children.get(name) ?? node.patterns.find(({pattern}) => pattern.test(name))?.node;
  node.isSeen = true;
  for (const name of header) {
    if (!seen(name)) faults.push(`${where}: column "${name}" isn't documented`);
    else seen(name).isSeen = true;
  }
  for (const [name, child] of node.children) {
    if (header.includes(name) || child.row.isOptional) continue;
    faults.push(`${where}: column "${name}" is documented and isn't there`);
  }
  rows.forEach((row, i) => {
    for (const name of header) {
      const one = seen(name)?.row;
      if (one && row[name] !== emptyCell) checkValue(row[name], one, `${where}, row ${i + 1}, ${name}`, faults);
    }
  });
  return rows.length;
}

/** The part of TOML that Palmar writes: tables, lists of tables, keys with values on one line or several. */
export function parseToml(text) {
  const root = {};
  let at = root, held = "";
  const strip = (line) => line.match(/^(?:[^"#]|"(?:[^"\\]|\\.)*")*/)[0].trim();
  const valueOf = (words) => JSON.parse(words
    .replace(/"(?:[^"\\]|\\.)*"|([A-Za-z_][A-Za-z0-9_]*)\s*=|,(?=\s*[\]}])/g, (all, key) =>
      key ? `"${key}":` : all === "," ? "" : all));
  for (const raw of text.split("\n")) {
    const line = held + strip(raw);
    held = "";
    if (line === "") continue;
    const head = line.match(/^(\[\[?)([^\]=]+)\]\]?$/);
    if (head) {
      const path = head[2].split(".");
      at = root;
      path.forEach((key, i) => {
        const isLast = i === path.length - 1;
        if (isLast && head[1] === "[[") (at[key] ??= []).push({});
        else at[key] ??= {};
        at = Array.isArray(at[key]) ? at[key].at(-1) : at[key];
      });
      continue;
    }
    const [, key, words] = line.match(/^([A-Za-z0-9_]+)\s*=\s*(.*)$/s);
    if ((words.match(/\[/g) ?? []).length > (words.match(/\]/g) ?? []).length) held = line + " ";
    else at[key] = valueOf(words);
  }
  return root;
}
