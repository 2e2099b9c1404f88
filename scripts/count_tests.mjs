// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node scripts/count_tests.mjs JUNIT FOLDER...: one line of all tests that ran: "N passed, N failed, N skipped".
//
// JUNIT is what `ctest --output-junit` wrote; the FOLDERs hold what GoogleTest's programs wrote (NAME.xml for
// ctest's entry NAME). An entry without such a file (a script, a program that crashed) counts as one test. What was
// skipped is listed before, with its reason.
import fs from 'node:fs';
import path from 'node:path';

const [junit, ...folders] = process.argv.slice(2);
const unescaped = (text) => text.replaceAll('&quot;', '"').replaceAll('&apos;', "'").replaceAll('&lt;', '<').replaceAll('&gt;', '>').replace(/&#x0?A;/gi, ' ').replaceAll('&amp;', '&');
let passed = 0, failed = 0;
const skipped = new Map();  // reason: names
const skip = (name, why) => skipped.set(why, [...(skipped.get(why) ?? []), name]);

const written = new Set();
for (const folder of folders) {
  for (const file of fs.existsSync(folder) ? fs.readdirSync(folder) : []) {
    const text = fs.readFileSync(path.join(folder, file), 'utf8');
    written.add(file.replace(/\.xml$/, ''));
    for (const [, head, body] of text.matchAll(/<testcase ([^>]*?)(?:\/>|>([\s\S]*?)<\/testcase>)/g)) {
      if (!/status="run"/.test(head)) continue;
      const name = `${/classname="([^"]*)"/.exec(head)?.[1]}.${/name="([^"]*)"/.exec(head)?.[1]}`;
      const reason = /<skipped message="([^"]*)"/.exec(body ?? '');
      if (/<failure/.test(body ?? '')) failed += 1;
      else if (reason || /result="skipped"/.test(head)) skip(name, unescaped(reason?.[1] ?? 'no reason given').replace(/^\S+:\d+\s*/, '').trim());
      else passed += 1;
    }
  }
}
for (const [, head, body] of fs.readFileSync(junit, 'utf8').matchAll(/<testcase ([^>]*?)(?:\/>|>([\s\S]*?)<\/testcase>)/g)) {
  const name = /name="([^"]*)"/.exec(head)?.[1] ?? '';
  const status = /status="(\w+)"/.exec(head)?.[1];
  if (status === 'run' || status === 'fail') {
    if (written.has(name)) continue;  // counted test by test
    if (status === 'fail') failed += 1;
    else passed += 1;
  } else {
    const said = unescaped(/<system-out>([\s\S]*?)<\/system-out>/.exec(body ?? '')?.[1] ?? '').trim().split('\n').pop();
    skip(name, said || 'no reason given');
  }
}
let skips = 0;
for (const [why, names] of [...skipped].sort()) {
  skips += names.length;
  console.log(`skipped: ${names.length > 3 ? `${names.length} tests, ${names[0]} ...` : names.join(', ')}: ${why}`);
}
console.log(`${passed} passed, ${failed} failed, ${skips} skipped`);
process.exit(failed > 0 || passed === 0 ? 1 : 0);
