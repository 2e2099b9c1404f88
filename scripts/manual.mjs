// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node scripts/manual.mjs PALMAR OUT
//
// Manual pages and completion for bash, zsh and fish, from what `palmar COMMAND --help` prints:
//
//     OUT/man/man1/palmar.1, palmar-hand-quick.1 ...
//     OUT/completions/palmar.bash, _palmar, palmar.fish
import {execFileSync} from "node:child_process";
import {mkdirSync, rmSync, writeFileSync} from "node:fs";
import {join} from "node:path";
import {fileURLToPath} from "node:url";

const kIndent = 30;  // of descriptions in help pages

/** A help page as {about, usage, sections: [{title, items: [{term, text}]}], example, ending}. */
export function parseHelp(text) {
  const page = {about: "", usage: "", sections: [], example: [], ending: []};
  let place = "about";
  for (const line of text.split("\n")) {
    if (line.startsWith("Usage: ")) {
      page.usage = line.slice("Usage: ".length);
      place = "usage";
    } else if (line.startsWith("Example: ")) {
      page.example.push(line.slice("Example: ".length));
      place = "example";
    } else if (/^\S.*:$/.test(line) && place !== "ending") {
      page.sections.push({title: line.slice(0, -1), items: []});
      place = "items";
    } else if (line.trim() === "") {
      continue;
    } else if (place === "about") {
      page.about += (page.about ? " " : "") + line.trim();
    } else if (place === "example" && line.startsWith(" ")) {
      page.example.push(line.trim());
    } else if (place === "items" && line.startsWith(" ")) {
      const items = page.sections.at(-1).items;
      if (line.length > 2 && line[2] !== " ") {
        const isLong = line[kIndent - 1] !== " " || /^(\.\.\.)?( ?REQUIRED)?$/.test(line.slice(kIndent));
        const term = isLong ? line.trim() : line.slice(0, kIndent).trim();
        items.push({term, text: isLong ? "" : line.slice(kIndent).trim()});
      } else {
        items.at(-1).text += (items.at(-1).text ? " " : "") + line.trim();
      }
    } else {
      place = "ending";
      page.ending.push(line.trim());
    }
  }
  return page;
}

/** Names of an option's term: "-h,--help" and "--out TEXT REQUIRED" -> ["-h", "--help"], ["--out"]. */
const namesOf = (term) => term.split(" ")[0].split(",").filter((name) => name.startsWith("-"));
const takesValue = (term) => term.split(" ").length > 1;
const optionsOf = (page) =>
  page.sections.filter((one) => one.title !== "Positionals" && one.title !== "Subcommands")
    .flatMap((one) => one.items);
const subcommandsOf = (page) => page.sections.find((one) => one.title === "Subcommands")?.items ?? [];

/** All commands below `words`, depth first: [{words, page}]. `help` gives the text of a page. */
export function walk(help, words = []) {
  const page = parseHelp(help(words));
  return [{words, page}, ...subcommandsOf(page).flatMap((one) => walk(help, [...words, one.term]))];
}

const roff = (text) => text.replaceAll("\\", "\\e").replaceAll("-", "\\-").replace(/^([.'])/, "\\&$1");

export function manPage({words, page}, version, all) {
  const name = ["palmar", ...words].join("-");
  const lines = [`.TH ${name.toUpperCase()} 1 "" "${version}" "Palmar"`, ".ad l", ".SH NAME",
    `${roff(name)} \\- ${roff(page.about)}`, ".SH SYNOPSIS", roff(page.usage)];
  for (const {title, items} of page.sections) {
    lines.push(`.SH ${title.toUpperCase()}`);
    for (const {term, text} of items) lines.push(".TP", `.B ${roff(term)}`, roff(text));
  }
  if (page.example.length > 0) {
    lines.push(".SH EXAMPLE", ".nf", ...page.example.map(roff), ".fi");
  }
  if (page.ending.length > 0) lines.push(".SH NOTES", roff(page.ending.join(" ")));
  const beside = all.filter(({words: other}) =>
    other.length === words.length + 1 && words.every((word, i) => other[i] === word) ||
    other.length === words.length - 1 && other.every((word, i) => words[i] === word));
  if (beside.length > 0) {
    lines.push(".SH SEE ALSO",
      beside.map(({words: other}) => `.BR ${roff(["palmar", ...other].join("-"))} (1)`).join(",\n"));
  }
  return lines.join("\n") + "\n";
}

export function bashCompletion(all) {
  const cases = all.map(({words, page}) => {
    const items = optionsOf(page);
    const options = items.flatMap(({term}) => namesOf(term));
    const valued = items.filter(({term}) => takesValue(term)).flatMap(({term}) => namesOf(term));
    const commands = subcommandsOf(page).map(({term}) => term);
    return `    "${["palmar", ...words].join(" ")}") commands="${commands.join(" ")}" ` +
      `options="${options.join(" ")}" valued="${valued.join(" ")}" ;;`;
  });
  return `# Completion of palmar in bash; made by scripts/manual.mjs.
_palmar_words() {
  commands="" options="" valued=""
  case "$1" in
${cases.join("\n")}
  esac
}
_palmar() {
  local current="\${COMP_WORDS[COMP_CWORD]}" path="palmar" commands options valued i word skip=0
  _palmar_words "$path"
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word="\${COMP_WORDS[i]}"
    if [ "$skip" = 1 ]; then skip=0; continue; fi
    if [[ " $commands " == *" $word "* ]]; then
      path="$path $word"
      _palmar_words "$path"
    elif [[ " $valued " == *" $word "* ]]; then
      skip=1
    fi
  done
  COMPREPLY=()
  if [ "$skip" = 1 ] || [[ "$current" != -* && -z "$commands" ]]; then
    compopt -o default 2>/dev/null
  elif [[ "$current" == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  else
    COMPREPLY=($(compgen -W "$commands" -- "$current"))
  fi
}
complete -F _palmar palmar
`;
}

const zshQuoted = (text) => text.replaceAll("'", "'\\''").replaceAll(":", "\\:");

export function zshCompletion(all) {
  const cases = all.map(({words, page}) => {
    const commands = subcommandsOf(page).map(({term, text}) => `'${zshQuoted(term)}:${zshQuoted(text)}'`);
    const options = optionsOf(page).flatMap(({term, text}) =>
      namesOf(term).map((name) => `'${zshQuoted(name)}:${zshQuoted(text)}'`));
    return `    '${["palmar", ...words].join(" ")}')\n      commands=(${commands.join(" ")})\n` +
      `      options=(${options.join(" ")}) ;;`;
  });
  return `#compdef palmar
# Completion of palmar in zsh; made by scripts/manual.mjs.
_palmar_words() {
  commands=() options=()
  case "$1" in
${cases.join("\n")}
  esac
}
_palmar() {
  local -a commands options
  local place=palmar word i
  _palmar_words "$place"
  for ((i = 2; i < CURRENT; ++i)); do
    word="\${words[i]}"
    if (( \${commands[(I)\${word}:*]} )); then
      place="$place $word"
      _palmar_words "$place"
    fi
  done
  if [[ "\${words[CURRENT]}" == -* ]]; then
    _describe option options
  elif (( \${#commands} )); then
    _describe command commands
  else
    _files
  fi
}
_palmar "$@"
`;
}

const fishQuoted = (text) => "'" + text.replaceAll("\\", "\\\\").replaceAll("'", "\\'") + "'";

export function fishCompletion(all) {
  const lines = ["# Completion of palmar in fish; made by scripts/manual.mjs.",
    "function __palmar_at",
    "    set -l words (commandline -opc | string match -v -- '-*')",
    "    set -l depth (count $argv)",
    "    test (count $words) -ge $depth; and test \"$words[1..$depth]\" = \"$argv\"",
    "end"];
  for (const {words, page} of all) {
    const at = ["palmar", ...words].join(" ");
    const commands = subcommandsOf(page);
    for (const {term, text} of commands) {
      lines.push(`complete -c palmar -f -n "__palmar_at ${at}; and not __fish_seen_subcommand_from ` +
        `${commands.map((one) => one.term).join(" ")}" -a ${term} -d ${fishQuoted(text)}`);
    }
    for (const {term, text} of optionsOf(page)) {
      const [name] = namesOf(term).filter((one) => one.startsWith("--"));
      if (name === undefined) continue;
      lines.push(`complete -c palmar -n "__palmar_at ${at}" -l ${name.slice(2)}` +
        `${takesValue(term) ? " -r" : ""} -d ${fishQuoted(text)}`);
    }
  }
  return lines.join("\n") + "\n";
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [palmar, out] = process.argv.slice(2);
  if (out === undefined) {
    console.error("usage: node scripts/manual.mjs PALMAR OUT");
    process.exit(2);
  }
  const run = (args) => execFileSync(palmar, args, {encoding: "utf8"});
  const version = run(["--version"]).trim().split(",")[0];
  const all = walk((words) => run([...words, "--help"]));
  rmSync(out, {recursive: true, force: true});
  mkdirSync(join(out, "man/man1"), {recursive: true});
  mkdirSync(join(out, "completions"));
  for (const one of all) {
    writeFileSync(join(out, "man/man1", ["palmar", ...one.words].join("-") + ".1"), manPage(one, version, all));
  }
  writeFileSync(join(out, "completions/palmar.bash"), bashCompletion(all));
  writeFileSync(join(out, "completions/_palmar"), zshCompletion(all));
  writeFileSync(join(out, "completions/palmar.fish"), fishCompletion(all));
  console.log(`${all.length} manual pages and three completions in ${out}`);
}
