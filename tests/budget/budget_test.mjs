// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node --test tests/budget/budget_test.mjs: the check of the budget can fail.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { compileUnits, complaints, readBudget, unsourcedConstants } from './budget.mjs';

const file = 'budget.toml';
const budget = readBudget('# words\n[lines]\n"palmar/contact" = { start = 10, most = 12, reason = "friction" }\n', file);

test('AModuleThatGrewIsNamedWithItsLimit', () => {
  assert.deepEqual(complaints({ lines: { 'palmar/contact': 12 } }, budget, file), []);
  assert.deepEqual(complaints({ lines: { 'palmar/contact': 13 } }, budget, file),
    ['budget.toml:3: lines of palmar/contact: 13; at most 12 are allowed']);
});

test('ARaiseNeedsAReason', () => {
  const raised = readBudget('[lines]\n"palmar/contact" = { start = 10, most = 12 }\n', file);
  assert.match(complaints({ lines: { 'palmar/contact': 11 } }, raised, file)[0], /raised from 10 to 12 without a reason/);
});

test('AModuleWithoutAnEntryAndAnEntryWithoutAModuleAreNamed', () => {
  const said = complaints({ lines: { 'palmar/grasp': 1 } }, budget, file);
  assert.match(said[0], /lines of palmar\/grasp \(1\) has no entry/);
  assert.match(said[1], /palmar\/contact is no module/);
});

test('ALineThatIsNoEntryIsRefusedWithItsPlace', () => {
  assert.throws(() => readBudget('[lines]\ncontact = 12\n', file), /budget\.toml:2: "contact = 12"/);
});

test('AConstantIsCountedUnlessItsLineOrTheCommentAboveNamesASource', () => {
  assert.equal(unsourcedConstants('constexpr double kEdge = 2.5;  // mm\n'), 1);
  assert.equal(unsourcedConstants('constexpr double kEdge = 2.5;  // mm; Xie 2014\n'), 0);
  assert.equal(unsourcedConstants('/// Source: Johnson 1985.\nconstexpr double kEdge = 2.5;\n'), 0);
  assert.equal(unsourcedConstants('/// Source: Johnson 1985.\n\nconstexpr double kEdge = 2.5;\n'), 1);
});

test('CompilingCountsInUnitsOfTheReferenceSource', () => {
  const log = '# ninja log v5\n0\t100\t1\ta.cpp.o\tx\n0\t300\t1\ta.cpp.o\tx\n0\t100\t1\teigen_orthogonal.cpp.o\tx\n0\t900\t1\tbin/palmar\tx\n';
  assert.equal(compileUnits(log), 4);
  assert.equal(compileUnits('# ninja log v5\n0\t100\t1\ta.cpp.o\tx\n'), undefined);
});
