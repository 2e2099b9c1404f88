// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node tests/programs/programs_test.mjs BIN
//
// What each program links: modules by the namespaces of its symbols, libraries by its dynamic section. A first
// report must not wait for what measures people or searches shapes to be built.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';

const hands = ['imaging', 'images', 'capture', 'phantom', 'person_records', 'person_report', 'person_workflow', 'board'];
/// Modules and libraries (how their names begin) that a program must not have, and some that it must.
const rules = {
  'palmar': { not: [...hands, 'redesign', 'validation', 'server', 'cad'], has: ['contact', 'grasp', 'study', 'workflow'],
              libraries: ['libTK', 'libopencv', 'libgdcm', 'libexif'] },
  'palmar-redesign': { not: [...hands, 'server', 'cad'], has: ['redesign', 'validation'], libraries: ['libTK', 'libopencv', 'libgdcm', 'libexif'] },
  'palmar-serve': { not: [...hands, 'redesign', 'validation', 'cad'], has: ['server'], libraries: ['libTK', 'libopencv', 'libgdcm', 'libexif'] },
  'palmar-hands': { not: ['redesign', 'validation', 'server', 'cad', 'board'], has: ['capture', 'phantom', 'imaging'],
                    libraries: ['libTK', 'libopencv', 'libgdcm'] },
  'palmar-cad': { not: [...hands, 'server', 'workflow', 'report'], has: ['cad'], libraries: ['libopencv', 'libgdcm', 'libexif', 'libduktape'] },
  'palmar-photo': { not: ['phantom', 'server', 'workflow', 'report', 'cad'], has: ['board'], libraries: ['libTK', 'libgdcm', 'libduktape'] },
  'palmar-dicom': { not: ['capture', 'phantom', 'server', 'workflow', 'report', 'cad', 'study'], has: ['images'], libraries: ['libTK', 'libopencv', 'libduktape'] },
};

const bin = process.argv[2];
if (!bin) {
  console.error('usage: node tests/programs/programs_test.mjs BIN');
  process.exit(2);
}
const output = (command, ...words) => execFileSync(command, words, { maxBuffer: 1 << 30, encoding: 'utf8' });
let wrong = 0;
for (const [program, { not, has, libraries }] of Object.entries(rules)) {
  const file = path.join(bin, program);
  if (!fs.existsSync(file)) {
    console.log(`${program}: isn't built`);
    continue;
  }
  const modules = new Set();
  for (const [, name] of output('nm', '-C', '--defined-only', file).matchAll(/ [TtWw] palmar::([a-z_]+)::/g)) modules.add(name);
  const linked = [...output('readelf', '-d', file).matchAll(/NEEDED.*\[(.*?)\]/g)].map(([, name]) => name);
  const found = [...not.filter((name) => modules.has(name)).map((name) => `has code of the module ${name}`),
    ...has.filter((name) => !modules.has(name)).map((name) => `has no code of the module ${name}`),
    ...libraries.flatMap((start) => linked.filter((name) => name.startsWith(start))).map((name) => `links ${name}`)];
  for (const what of found) console.error(`${program} ${what}`);
  wrong += found.length;
  console.log(`${program}: ${(fs.statSync(file).size / 1e6).toFixed(1)} MB, modules ${[...modules].sort().join(' ')}; libraries ${linked.filter((name) => !/^lib(stdc\+\+|m|c|gcc_s)\.so/.test(name)).join(' ')}`);
}
process.exit(wrong > 0 ? 1 : 0);
