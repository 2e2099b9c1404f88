// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A made-up tree for the tests of the checks.
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";

/** What `look(root)` says of a tree with these files: {path: text}. */
export function in_tree(files, look) {
  const root = mkdtempSync(join(tmpdir(), "palmar_layers_"));
  try {
    for (const [path, text] of Object.entries(files)) {
      mkdirSync(dirname(join(root, path)), { recursive: true });
      writeFileSync(join(root, path), text);
    }
    return look(root);
  } finally {
    rmSync(root, { recursive: true });
  }
}
