// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node manual_test.mjs PALMAR: manual pages and completion (scripts/manual.mjs) of the real program.
// The shells that are there judge what is made for them.
import assert from "node:assert/strict";
import {execFileSync, spawnSync} from "node:child_process";
import {mkdtempSync, readFileSync, readdirSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import {dirname, join} from "node:path";
import {fileURLToPath} from "node:url";

import {parseHelp} from "../../scripts/manual.mjs";

const palmar = process.argv[2];
const script = join(dirname(fileURLToPath(import.meta.url)), "../../scripts/manual.mjs");
const folder = mkdtempSync(join(tmpdir(), "palmar-manual-"));
const out = join(folder, "manual");
const has = (program) => spawnSync(program, ["--version"]).status === 0;

// A page that was typed here, with terms that just fill their column or are wider.
const page = parseHelp(`What it does
Usage: palmar thing [OPTIONS] FILE

Positionals:
  FILE TEXT REQUIRED          What it reads

Start here:
  --population TEXT=[xie2014] ...
                              Whose hands hold it
  -q,--quick                  In a hurry: less
  --a-name-of-some-length INT Twenty-seven wide

Example: palmar thing x
         palmar other y
Exit codes: 0 done.
`);
assert.equal(page.about, "What it does");
assert.deepEqual(page.sections.map((one) => one.title), ["Positionals", "Start here"]);
assert.deepEqual(page.sections[1].items, [
  {term: "--population TEXT=[xie2014] ...", text: "Whose hands hold it"},
  {term: "-q,--quick", text: "In a hurry: less"},
  {term: "--a-name-of-some-length INT", text: "Twenty-seven wide"},
]);
assert.deepEqual(page.example, ["palmar thing x", "palmar other y"]);
assert.deepEqual(page.ending, ["Exit codes: 0 done."]);

try {
  execFileSync("node", [script, palmar, out]);
  const pages = readdirSync(join(out, "man/man1"));
  // Every command that a help page names has a page, and every long option of its help is in it.
  let commands = 0;
  const visit = (words) => {
    const help = execFileSync(palmar, [...words, "--help"], {encoding: "utf8"});
    const file = ["palmar", ...words].join("-") + ".1";
    assert.ok(pages.includes(file), file);
    const text = readFileSync(join(out, "man/man1", file), "utf8").replaceAll("\\-", "-").replaceAll("\\&", "");
    for (const [, option] of help.matchAll(/^ {2}(?:-\w,)?(--[a-z0-9-]+)/gm)) {
      assert.ok(text.includes(option), `${file}: ${option}`);
    }
    ++commands;
    const below = help.match(/^Subcommands:\n((?: .*\n)+)/m);
    for (const [, name] of (below?.[1] ?? "").matchAll(/^ {2}(\S+)/gm)) visit([...words, name]);
  };
  visit([]);
  assert.equal(pages.length, commands);
  assert.ok(commands > 60, `${commands} commands`);

  if (has("groff")) {
    for (const file of pages) {
      const run = spawnSync("groff", ["-man", "-Tutf8", "-ww", join(out, "man/man1", file)], {encoding: "utf8"});
      // A path or a list of values may be wider than the page.
      assert.equal(run.stderr.replaceAll(/^.*can't break line\n/gm, ""), "", file);
    }
  }
  const bash = join(out, "completions/palmar.bash");
  const complete = (...words) => execFileSync("bash", ["-c",
    `source ${bash}; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _palmar 2>/dev/null; echo "\${COMPREPLY[*]}"`,
    "bash", ...words], {encoding: "utf8"}).trim();
  assert.equal(complete("palmar", "redesign", "sh"), "shape");
  assert.equal(complete("palmar", "--threads", "2", "hand", "qui"), "quick");
  assert.match(complete("palmar", "assess", "a.stl", "--un"), /--unit/);
  assert.equal(complete("palmar", "assess", "--unit", "m"), "");  // a value, no command
  assert.match(complete("palmar", ""), /\bassess\b.*\bserve\b/);
  if (has("zsh")) execFileSync("zsh", ["-n", join(out, "completions/_palmar")]);
  if (has("fish")) {
    const answer = execFileSync("fish", ["-c",
      `source ${join(out, "completions/palmar.fish")}; complete -C "palmar redesign sh"`], {encoding: "utf8"});
    assert.match(answer, /^shape\t/);
  }
  console.log(`${commands} commands: manual pages and completion are whole`);
} finally {
  rmSync(folder, {recursive: true, force: true});
}
