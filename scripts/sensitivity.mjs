// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node scripts/sensitivity.mjs [--share DIR] [--only TEXT] [--jobs N] [--minutes N] [--built] [--measured] [--page]
//
// Which constants of a hold shape its figures, and by how much? Copies the sources to build/sensitivity, where
// every constant is one that can be changed while the program runs (scripts/sensitivity/constants.mjs), builds
// that copy with a program that holds eight products (scripts/sensitivity/sensitivity.cpp), and has it change one
// constant after the other by 5 %. Prints the page docs/method/sensitivity.md; --page writes it. --only: constants
// whose name or file contains the text, and those that say how large chance is. --share: folder with the built-in
// hand, otherwise that of build/release. --jobs: programs at a time, otherwise one per processor. --minutes: no
// constant is begun later than that. --built: the copy is taken as it was built last. --measured: nothing is built
// or measured, the page is written from what was measured last, by a run that was stopped, too. What the same program
// has measured before isn't measured again. The program that people use keeps its constants as they are.
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, readFileSync, symlinkSync, writeFileSync } from "node:fs";
import { availableParallelism } from "node:os";
import { dirname, join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { anew_for, id_of, with_changeable_constants } from "./sensitivity/constants.mjs";
import { page_of } from "./sensitivity/page.mjs";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const copy = join(root, "build", "sensitivity");
const tree = join(copy, "tree");
const kept = join(copy, "measured.json");
const known_fixed = join(copy, "fixed.json");
const built_last = join(copy, "built.json");
const page = join(root, "docs", "method", "sensitivity.md");
/** Rounds of building: constants that the compiler has to know are found by its messages. */
const most_rounds = 8;
/** Minutes that one constant may take; a program that takes longer is ended, and the constant is told as one that hangs. */
const most_minutes = 5;
/** So that a search that goes on from where it ended finds what a small change does, it ends later in the copy. */
const least_gain = 1e-3;
const tight = [["kOnSkin.least_gain", least_gain], ["kWithFingertips[1].least_gain", least_gain], ["kInNeed.least_gain", least_gain],
  // Prices that are low at first would lead it away again.
  ["kWithFingertips[0].least_gain", 1e9]];
const tight_file = "grasp/equilibrium/least_effort.cpp";
/** What is measured first: how large chance is, then what is wanted most. */
const order = ["steering", "rest", "prepared", "closed", "fingertips", "searched", "ranked", "compliance"];
/** So many constants are measured between two times that what was found is kept. */
const kept_every = 20;

function option(name, otherwise) {
  const k = process.argv.indexOf(name);
  return k < 0 ? otherwise : process.argv[k + 1];
}

// ---- The copy -----------------------------------------------------------------------------------

/** Writes a file of the copy only if it is new, so that little is compiled again. */
function put(file, text) {
  const target = join(tree, file);
  if (existsSync(target) && readFileSync(target).equals(Buffer.from(text))) return;
  mkdirSync(dirname(target), { recursive: true });
  writeFileSync(target, text);
}

/** Constants of `files` (name -> text) that some constexpr that stays needs: the compiler has to know them. */
function needed_by_others(file, text) {
  const needed = new Set();
  const code = text.replace(/\/\/[^\n]*/g, "");
  for (const [statement] of code.matchAll(/\b(?:static_assert\s*\([^;]*;|constexpr [^;{(]*[={[][^;]*;)/g)) {
    for (const [name] of statement.matchAll(/\bk[A-Z]\w*/g)) needed.add(`${file}:${name}`);
  }
  for (const [, name] of code.matchAll(/(?:\[|array<[^<>;]*,\s*)(k[A-Z]\w*)\s*[\]>]/g)) needed.add(`${file}:${name}`);
  return needed;
}

function sources_of_copy() {
  return execFileSync("git", ["ls-files", "-co", "--exclude-standard"], { cwd: root, encoding: "utf8" })
    .split("\n").filter((file) => file && existsSync(join(root, file)) && !/^(docs|data\/.*\.stl)\//.test(file) && file !== "node_modules");
}

function build_copy() {
  const sources = sources_of_copy();
  // Those of the last time are no news; if one of them needn't be fixed any more, deleting the folder tells.
  const fixed = new Set(existsSync(known_fixed) ? JSON.parse(readFileSync(known_fixed, "utf8")) : []);
  const binary = join(tree, "build", "release");
  for (let round = 1; round <= most_rounds; ++round) {
    const constants = [];
    for (const file of sources) {
      let text = readFileSync(join(root, file));
      const inside = file.replace("src/palmar/", "");
      if (inside !== file && /\.(h|cpp)$/.test(file) && anew_for(inside)) {
        // What stays constexpr may need others: they stay, too.
        let made = with_changeable_constants(inside, text.toString(), fixed);
        for (let before = -1; before !== fixed.size;) {
          before = fixed.size;
          for (const id of needed_by_others(inside, made.text)) {
            if (made.constants.some((one) => one.id === id)) fixed.add(id);
          }
          made = with_changeable_constants(inside, text.toString(), fixed);
        }
        constants.push(...made.constants);
        text = made.text;
      }
      if (file === "CMakeLists.txt") {
        text = `${text}\nadd_executable(sensitivity scripts/sensitivity/sensitivity.cpp)\n` +
          "target_link_libraries(sensitivity PRIVATE palmar::grasp palmar::records palmar::compiler nlohmann_json::nlohmann_json fmt::fmt)\n";
      }
      put(file, text);
    }
    put("src/palmar/core/varied.h", readFileSync(join(root, "scripts", "sensitivity", "varied.h")));
    if (!existsSync(join(tree, "node_modules"))) symlinkSync(join(root, "node_modules"), join(tree, "node_modules"));
    execFileSync("cmake", ["--preset", "release", "-DPALMAR_WERROR=OFF", "-DPALMAR_TESTS=OFF", "-DPALMAR_BENCHMARKS=OFF", "-DPALMAR_PYTHON=OFF"],
                 { cwd: tree, stdio: ["ignore", "ignore", "inherit"] });
    console.error(`Building ${constants.length} constants, round ${round}`);
    const build = spawnSync("ninja", ["-C", binary, "-k", "0", "-j", String(availableParallelism()), "sensitivity"], { encoding: "utf8", maxBuffer: 1 << 28 });
    writeFileSync(known_fixed, JSON.stringify([...fixed]));
    if (build.status === 0) {
      const built = { constants, program: join(binary, "bin", "sensitivity") };
      writeFileSync(built_last, JSON.stringify(built));
      return built;
    }
    const before = fixed.size;
    const said = build.stdout.split("\n");
    for (const one of constants) {
      const name = one.name.replace(/[.[].*/, "");
      // The message that a constant isn't constant, or that the number of a list can't be put where it stands.
      const is_said = said.some((line) => (line.includes(`'${name}'`) && /constant expression|initialized by/.test(line)) ||
        (line.includes(one.file) && /cannot be narrowed|constant expression/.test(line) && is_at(line, one)));
      if (is_said) fixed.add(name === one.name ? one.id : `${one.file}:${one.name.startsWith("k") ? name : one.name}`);
    }
    if (fixed.size === before) {
      console.error(said.filter((line) => /error/.test(line)).slice(0, 20).join("\n"));
      throw new Error("the copy doesn't build; its first errors are above");
    }
  }
  throw new Error(`the copy doesn't build after ${most_rounds} rounds`);
}

/** Whether a message of the compiler is about the line where a constant stands. */
function is_at(message, one) {
  const line = Number(/:(\d+):\d+: /.exec(message)?.[1]);
  const text = readFileSync(join(tree, "src", "palmar", one.file), "utf8").split("\n");
  return text.slice(Math.max(0, line - 1), line).some((code) => code.includes(one.name));
}

// ---- Results ------------------------------------------------------------------------------------

/** One program; ask(line) gives what it answers, or nothing if it ended or takes too long. */
function start(program, share) {
  const child = spawn(program, [share], { stdio: ["pipe", "pipe", "inherit"] });
  const waiting = [];
  createInterface({ input: child.stdout }).on("line", (line) => waiting.shift()?.(JSON.parse(line)));
  child.stdin.on("error", () => { /* it has ended: told where it is waited for */ });
  child.on("exit", () => waiting.splice(0).forEach((tell) => tell(undefined)));
  for (const [name, factor] of tight) {
    child.stdin.write(`tight ${id_of(tight_file, name).replace("ULL", "")} ${factor}\n`);
  }
  return {
    end: () => child.stdin.end(),
    ask: (line, minutes) => new Promise((resolve) => {
      if (child.exitCode !== null || child.signalCode !== null) return resolve(undefined);
      const timer = setTimeout(() => child.kill(), 60000 * minutes);
      waiting.push((answer) => {
        clearTimeout(timer);
        resolve(answer);
      });
      child.stdin.write(`${line}\n`);
    }),
  };
}

/** Measures those of `varied` that `before` hasn't; `keep` gets {held, results, minutes} now and then, and at the end. */
async function measure(program, varied, share, jobs, most, before, keep) {
  const begin = Date.now();
  const minutes = () => (Date.now() - begin) / 60000;
  const results = before?.results ?? {};
  let held = before?.held;
  const left = varied.filter(({ id }) => !(id in results)).sort((a, b) => order.indexOf(a.anew) - order.indexOf(b.anew));
  const found = () => ({ held, results, minutes: (before?.minutes ?? 0) + minutes() });
  const worker = async () => {
    let one_program;
    for (;;) {
      if (!one_program) {
        one_program = start(program, share);
        const answer = await one_program.ask("hold", 30);
        if (!answer) throw new Error("the products can't be held");
        held ??= answer.held;
      }
      const one = minutes() < most ? left.shift() : undefined;
      if (!one) break;
      const id = id_of(one.file, one.name).replace("ULL", "");
      let answer = await one_program.ask(`${one.anew} ${id}`, most_minutes);
      if (answer && one.anew === "steering") {
        // As in use, too.
        const searched = await one_program.ask(`searched ${id}`, most_minutes);
        answer = searched && { ...answer, searched: searched.results, seconds: answer.seconds + searched.seconds };
      }
      results[one.id] = answer ?? { error: "the program ended, or took too long" };
      if (!answer) one_program = undefined;
      const count = Object.keys(results).length;
      if (count % kept_every === 0) {
        keep(found());
        console.error(`${count} of ${varied.length} constants, ${minutes().toFixed(1)} min`);
      }
    }
    one_program.end();
  };
  if (left.length > 0) await Promise.all(Array.from({ length: jobs }, worker));
  keep(found());
}

/** Builds and measures; what is found is kept. */
async function make_anew() {
  const share = option("--share", join(root, "build", "release", "share", "palmar"));
  if (!existsSync(join(share, "template.hand.glb"))) {
    throw new Error(`${share} has no template.hand.glb: build Palmar first, or name a folder with --share`);
  }
  mkdirSync(copy, { recursive: true });
  const begin = Date.now();
  const built = process.argv.includes("--built") ? JSON.parse(readFileSync(built_last, "utf8")) : build_copy();
  const { constants } = built;
  const gone = tight.filter(([name]) => !constants.some((one) => one.file === tight_file && one.name === name && !one.is_fixed));
  if (gone.length > 0) throw new Error(`${tight_file} has no changeable ${gone.map(([name]) => name).join(", ")}: mend \`tight\` in this script`);
  console.error(`Built in ${((Date.now() - begin) / 60000).toFixed(1)} min`);
  const program = createHash("sha256").update(readFileSync(built.program)).digest("hex");
  const before = existsSync(kept) ? JSON.parse(readFileSync(kept, "utf8")) : undefined;
  const only = option("--only", "");
  const varied = constants.filter(({ id, anew, is_fixed, value }) =>
    (id.includes(only) || anew === "steering") && anew !== "never" && !is_fixed && !value.startsWith("std::numbers"));
  await measure(built.program, varied, share, Number(option("--jobs", availableParallelism())), Number(option("--minutes", Infinity)),
                before?.program === program ? before : undefined, (found) => {
    writeFileSync(kept, JSON.stringify({ program, date: new Date().toISOString().slice(0, 10), constants, ...found }, undefined, 1));
  });
}

if (!process.argv.includes("--measured")) await make_anew();
const measured = JSON.parse(readFileSync(kept, "utf8"));
// Kinds as they are told now.
const constants = measured.constants.map((one) => ({ ...one, anew: anew_for(one.file, one.name) })).filter(({ anew }) => anew);
const text = page_of({ ...measured, constants });
if (process.argv.includes("--page")) writeFileSync(page, text);
else console.log(text);
