// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The little of node that the tests use.
declare module "node:test" {
  export function test(name: string, run: () => void): void;
}
declare module "node:fs" {
  export function readFileSync(path: string, encoding: string): string;
  export function readdirSync(path: string): string[];
  export function statSync(path: string): { isDirectory(): boolean };
}
declare module "node:assert/strict" {
  const assert: {
    ok(value: unknown, message?: string): void;
    equal(actual: unknown, expected: unknown, message?: string): void;
    deepEqual(actual: unknown, expected: unknown, message?: string): void;
    throws(run: () => void, message: RegExp): void;
    match(text: string, pattern: RegExp): void;
    doesNotMatch(text: string, pattern: RegExp): void;
  };
  export default assert;
}
declare function btoa(bytes: string): string;
declare function atob(text: string): string;
