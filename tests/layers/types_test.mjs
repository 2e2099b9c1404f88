// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node tests/layers/types_test.mjs: the check for types defined twice sees what it is there for.
import assert from "node:assert/strict";
import { in_tree } from "./made_up_tree.mjs";
import { twice_defined, types_of } from "./types.mjs";

const names = (text) => types_of(text).map((type) => type.name);
const inside = (space, text) => `namespace ${space} {\n${text}\n}\n`;

// Every way to define a type, with the namespaces round it.
assert.deepEqual(names(inside("palmar::contact", `
  struct Press { struct Step { int n; }; };
  class [[nodiscard]] Skin final : public Body<int> { public: enum class Layer { kOuter }; };
  enum class Status : int { kHeld };
  enum Kind { kOne };
  union Word { int a; float b; };
  using Json = nlohmann::ordered_json;
  template <class Key, template <class> class Map = std::map> struct Table { Key key; };
  template <> struct hash<Press> { };
  struct PreparedHand::Impl { };
`)), ["Press", "Skin", "Status", "Kind", "Word", "Json", "Table", "hash< Press >", "PreparedHand::Impl"]
  .map((name) => `palmar::contact::${name}`));
assert.deepEqual(names(inside("palmar", inside("press", "struct A {};") + "struct B {};")),
  ["palmar::press::A", "palmar::B"]);
assert.deepEqual(names(`extern "C" { struct A {}; }`), ["A"]);

// What defines none, or none at a named namespace.
assert.deepEqual(names(inside("palmar", `
  struct Press;
  enum class Status : int;
  struct Press* made(); class Skin skin_of(struct Press press) { struct Local { int n; }; return {}; }
  using namespace std;
  using std::vector;
  namespace fs = std::filesystem;
  // struct Comment {};
  /* struct Comment {}; */
  const char* text = "struct Text {"; const char quote = '"', brace = '{'; const int many = 1'000;
  const char* raw = R"(struct Raw {)";
  const auto lambda = [] { struct InLambda { int n; }; return 0; };
`) + inside("", "struct Hidden {};") + inside("palmar", inside("", inside("deep", "struct Hidden {};")))), []);
assert.throws(() => types_of("namespace palmar {", "a.h"), /a\.h: 1 braces stay open/);

// Twice in two headers, a header and a source, two sources, a module and a program.
const twice = (files) => in_tree(files, (root) => twice_defined(root));
const press = (space) => inside(space, "struct Press { int n; };");
assert.deepEqual(twice({
  "src/palmar/contact/press.h": press("palmar::contact"),
  "src/palmar/contact/solve/press_again.h": press("palmar::contact"),
}), ["palmar::contact::Press: src/palmar/contact/press.h:2, src/palmar/contact/solve/press_again.h:2"]);
assert.deepEqual(twice({
  "src/palmar/contact/a.cpp": inside("palmar", "") + inside("palmar::contact", "enum class Press { kDeep };"),
  "apps/palmar/b.cpp": inside("palmar", inside("contact", "\nusing Press = int;")),
}), ["palmar::contact::Press: src/palmar/contact/a.cpp:5, apps/palmar/b.cpp:4"]);

// Once each: other namespaces, made known first, hidden, inside another type.
assert.deepEqual(twice({
  "src/palmar/contact/press.h": inside("palmar::contact", "struct Press;") + press("palmar::contact"),
  "src/palmar/grasp/press.h": press("palmar::grasp"),
  "src/palmar/contact/hidden.cpp": inside("palmar::contact", press("")),
  "src/palmar/contact/other.h": inside("palmar::contact", "struct Other { struct Press {}; };"),
}), []);

// By module: a name in two modules is fine, in one it is not.
const kFlat = { "src/palmar/contact/press.h": press("palmar"), "src/palmar/grasp/press.h": press("palmar") };
assert.equal(twice(kFlat).length, 1);
assert.deepEqual(in_tree(kFlat, (root) => twice_defined(root, true)), []);
assert.deepEqual(in_tree({ ...kFlat, "src/palmar/grasp/hold/press.cpp": press("palmar") }, (root) => twice_defined(root, true)),
  ["palmar::grasp::Press: src/palmar/grasp/hold/press.cpp:2, src/palmar/grasp/press.h:2"]);
assert.throws(() => twice({ "src/palmar/empty.h": "" }), /No type was found/);
console.log("The check for types defined twice fails where it must");
