// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node scripts/compile_hands.mjs BUILD
//
// Whether the programs of the house next door (src/hands, palmar-hands and its children) still compile, without
// making their code, which costs a third of building them: ./check runs this where it doesn't build them. The build
// directory has to have the precompiled headers. Ends with 1 if a source doesn't compile.
import {spawn} from "node:child_process";
import {readFileSync} from "node:fs";
import {availableParallelism} from "node:os";
import {join} from "node:path";

const build = process.argv[2];
if (!build) {
  console.error("usage: node scripts/compile_hands.mjs BUILD");
  process.exit(2);
}
const commands = JSON.parse(readFileSync(join(build, "compile_commands.json"), "utf8"))
  .filter(({command}) => /-o (src\/hands|apps\/palmar-(hands|photo|dicom))\//.test(command) && !/_tests\.dir\//.test(command))
  .map(({command, directory}) => ({directory, command: command.replace(/ -o \S+ -c /, " -fsyntax-only ")}));
if (commands.length === 0) {
  console.error(`${build}: compile_commands.json has no source of src/hands`);
  process.exit(1);
}
const total = commands.length;
let failed = 0;
const one = () => {
  const next = commands.shift();
  if (!next) return;
  spawn("sh", ["-c", next.command], {cwd: next.directory, stdio: "inherit"}).on("close", (code) => {
    if (code !== 0) ++failed;
    one();
  });
};
for (let i = 0; i < availableParallelism(); ++i) one();
process.on("exit", (code) => {
  console.log(`${total - failed} of ${total} batches of src/hands compile`);
  if (code === 0 && failed > 0) process.exitCode = 1;
});
