// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node tests/layers/types.mjs ROOT [--by-module]
//
// Finds types that are defined twice at one namespace in ROOT/src and ROOT/apps: undefined behaviour that
// no compiler sees when the two stand in different sources. Looked at are struct, class, union, enum and
// using at the scope of a namespace, also those of sources and tests, which are linked together; not those
// in anonymous namespaces, in types and in functions. A type made known first and then defined counts once.
// --by-module: what stands in the namespace palmar itself counts once for each module (folder of src/palmar).
// types_test.mjs shows it trees that must fail.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { code_files, report } from "./source_tree.mjs";

/** Words, numbers, "::" and single signs of a source, with their lines; comments, literals and directives left out. */
function tokens_of(text) {
  const kToken = new RegExp([
    /(?<skip>\/\/(?:\\\n|[^\n])*|\/\*[^]*?\*\/|^[ \t]*#(?:\\\n|\/\*[^]*?\*\/|[^\n])*)/,
    /(?<raw>(?:u8|[uUL])?R"(?<mark>[^()\\\s]{0,16})\([^]*?\)\k<mark>")/,
    /(?<text>"(?:\\[^]|[^"\\\n])*"|(?<![0-9a-fA-F])'(?:\\[^]|[^'\\\n])+')/,
    /(?<word>[A-Za-z_]\w*|\d(?:'?[\w.])*|::|[^\s])/,
  ].map((part) => part.source).join("|"), "gm");
  const tokens = [];
  let line = 1, read = 0;
  for (const match of text.matchAll(kToken)) {
    for (; read < match.index; ++read) if (text[read] === "\n") ++line;
    if (match.groups.word) tokens.push({ word: match[0], line });
    else if (!match.groups.skip) tokens.push({ word: '""', line });
  }
  return tokens;
}

/** The place after the bracket that closes the one at `i`. */
function after_brackets(tokens, i, open, close) {
  for (let depth = 0; i < tokens.length; ++i) {
    if (tokens[i].word === open) ++depth;
    else if (tokens[i].word === close && --depth === 0) return i + 1;
  }
  return i;
}

/**
 * Name of the type that the keyword at `i` defines, as "PreparedHand::Impl" or "hash<Vec3>"; undefined if it
 * only mentions one. `end` is the place of its body.
 */
function defined_type(tokens, i) {
  const kind = tokens[i++].word;
  const word = () => tokens[i]?.word;
  if (kind === "enum" && (word() === "class" || word() === "struct")) ++i;
  for (;;) {  // attributes
    if (word() === "[") i = after_brackets(tokens, i, "[", "]");
    else if (word() === "alignas") i = after_brackets(tokens, i + 1, "(", ")");
    else break;
  }
  let name = "";
  while (/^\w/.test(word() ?? "") && word() !== "final" || word() === "::" || word() === "<") {
    if (word() === "<") {
      const end = after_brackets(tokens, i, "<", ">");
      name += tokens.slice(i, end).map((token) => token.word).join(" ");
      i = end;
    } else {
      if (/\w$/.test(name) && word() !== "::") return undefined;  // two words: a variable of that type
      name += tokens[i++].word;
    }
  }
  if (name === "" || !/^(::|[A-Za-z_])/.test(name)) return undefined;
  if (kind === "using") return word() === "=" ? { name, end: i } : undefined;
  if (word() === "final") ++i;
  if (word() === ":") while (i < tokens.length && word() !== "{" && word() !== ";") ++i;
  return word() === "{" ? { name, end: i } : undefined;
}

/** [{name, line}] of the types that a source defines at named namespaces, each name with its namespace. */
export function types_of(text, file = "source") {
  const tokens = tokens_of(text);
  const scopes = [];  // of each open brace: the namespace's name, "" in extern "C"; null in all else
  const types = [];
  for (let i = 0; i < tokens.length; ++i) {
    const { word, line } = tokens[i];
    const is_at_namespace = scopes.every((scope) => scope !== null);
    if (word === "}") {
      if (scopes.length === 0) throw new Error(`${file}:${line}: a brace closes that none has opened`);
      scopes.pop();
    } else if (word === "{") {
      const is_linkage = tokens[i - 2]?.word === "extern" && tokens[i - 1].word === '""';
      scopes.push(is_linkage ? "" : null);
    } else if (word === "template" && tokens[i + 1]?.word === "<") {
      i = after_brackets(tokens, i + 1, "<", ">") - 1;
    } else if (word === "namespace") {
      let name = "";
      while (++i < tokens.length && !["{", ";", "="].includes(tokens[i].word)) name += tokens[i].word;
      if (tokens[i]?.word === "{") scopes.push(name === "" ? null : name);
    } else if (is_at_namespace && ["struct", "class", "union", "enum", "using"].includes(word)) {
      const type = defined_type(tokens, i);
      if (!type) continue;
      types.push({ name: [...scopes.filter(Boolean), type.name].join("::"), line });
      i = type.end - 1;
    }
  }
  if (scopes.length > 0) throw new Error(`${file}: ${scopes.length} braces stay open`);
  return types;
}

/** Types below root/src and root/apps that are defined twice, a line each; empty if none is. */
export function twice_defined(root, is_by_module = false) {
  const places = new Map();
  const files = ["src", "apps"].flatMap((folder) => code_files(join(root, folder), root));
  for (const file of files) {
    const module = is_by_module ? /^src\/palmar\/(\w+)\//.exec(file)?.[1] : undefined;
    for (const type of types_of(readFileSync(join(root, file), "utf8"), file)) {
      const name = module ? type.name.replace(/^palmar::(?=[A-Z])/, `palmar::${module}::`) : type.name;
      places.set(name, [...(places.get(name) ?? []), `${file}:${type.line}`]);
    }
  }
  if (places.size === 0) throw new Error(`No type was found below ${root}/src`);
  return [...places].filter(([, where]) => where.length > 1).map(([name, where]) => `${name}: ${where.join(", ")}`);
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  report(twice_defined(process.argv[2], process.argv[3] === "--by-module"), "Types defined twice", "No type is defined twice at one namespace");
}
