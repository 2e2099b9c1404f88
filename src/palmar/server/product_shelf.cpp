// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/product_shelf.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/product/intake/unit_guard.h"
#include "palmar/records/product/made_product.h"
#include "palmar/server/access.h"
#include "palmar/server/live_request.h"
#include "palmar/workflow/product/product_choice.h"

namespace palmar::server {
namespace {

constexpr std::size_t kMostHands = 6;  // some 60 MB each

/// The sides of its box in its own unit, if the unit is all that is missing.
std::optional<UnitQuestion> unit_question(const std::filesystem::path& path) {
  try {
    const formats::MeshFile file = formats::read_mesh(path);
    if (file.unit) return std::nullopt;
    Box3 box;
    for (const Vec3& v : file.mesh.vertices) box.extend(v);
    product::decide_unit(box, std::nullopt, geometry::LengthUnit::kMillimetre, path.string());
    return UnitQuestion{box.sizes()};
  } catch (const Error&) {
    return std::nullopt;  // something else is wrong with it
  }
}

std::string make_command(const ShelvedExample& example, const std::string& file) {
  std::string command = "palmar product make " + example.kind;
  for (const auto& [name, value] : example.given) {
    std::string option = name;
    std::replace(option.begin(), option.end(), '_', '-');
    command += " --" + option + " " + formats::shortest(value);
  }
  return command + " --out " + file;
}

}  // namespace

const std::vector<ShelvedExample>& shelved_examples() {
  static const std::vector<ShelvedExample> examples = {
      {"round-handle", "cylinder", {{"diameter_mm", 40}, {"length_mm", 130}}},
      {"edged-handle",
       "prism",
       {{"width_mm", 40}, {"depth_mm", 30}, {"length_mm", 130}, {"fillet_mm", 3}}},
      {"ball", "sphere", {{"diameter_mm", 65}}},
  };
  return examples;
}

std::shared_ptr<const product::Product> read_product(const ShelvedProduct& shelved,
                                                     const Progress& progress) {
  workflow::ProductChoice choice(shelved.path, {.unit = shelved.unit});
  auto product = std::make_shared<product::Product>(load_product(choice, progress));
  workflow::add_findings(*product);
  product->source = shelved.argument;  // not our folder's
  return product;
}

ProductShelf::ProductShelf() {
  std::string name = (std::filesystem::temp_directory_path() / "palmar-serve-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw OutputError(name + ": the folder can't be made: " + std::strerror(errno));
  }
  folder_ = name;
}

ProductShelf::~ProductShelf() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::filesystem::path ProductShelf::new_folder() {
  const std::scoped_lock lock(mutex_);
  const std::filesystem::path path = folder_ / std::to_string(++count_);
  formats::create_folder(path);
  return path;
}

ShelvedProduct ProductShelf::put(ShelvedProduct product) {
  const std::scoped_lock lock(mutex_);
  product.key = "p" + std::to_string(++count_);
  products_.push_back(product);
  if (products_.size() > kMost) products_.erase(products_.begin());
  if (product.product) keep_read(product.key);
  return product;
}

void ProductShelf::keep_read(const std::string& key) {
  std::erase(read_, key);
  read_.push_back(key);
  if (read_.size() <= kMostRead) return;
  for (ShelvedProduct& one : products_) {
    if (one.key == read_.front()) one.product.reset();
  }
  read_.erase(read_.begin());
}

ProductShelf::Added ProductShelf::add_bytes(const std::string& name, std::string_view bytes,
                                            std::optional<geometry::LengthUnit> unit,
                                            const Progress& progress) {
  Added added;
  added.product.file_name = safe_file_name(name);
  added.product.argument = added.product.file_name;
  added.product.unit = unit;
  added.product.path = new_folder() / added.product.file_name;
  formats::write_file(added.product.path, bytes);
  try {
    added.product.product = read_product(added.product, progress);
  } catch (const InputError& error) {
    if (!unit) added.question = unit_question(added.product.path);
    std::error_code ignored;
    std::filesystem::remove_all(added.product.path.parent_path(), ignored);
    if (added.question) return added;
    // Clients know the file by its name alone.
    std::string message = error.what();
    const std::string path = added.product.path.string();
    for (std::size_t at = message.find(path); at != std::string::npos; at = message.find(path)) {
      message.replace(at, path.size(), added.product.file_name);
    }
    throw InputError(message);
  }
  added.product = put(std::move(added.product));
  return added;
}

ShelvedProduct ProductShelf::add_file(const std::filesystem::path& path,
                                      std::optional<geometry::LengthUnit> unit) {
  ShelvedProduct product;
  product.file_name = path.filename().string();
  product.path = path;
  product.argument = path.string();
  product.unit = unit;
  return put(std::move(product));
}

ShelvedProduct ProductShelf::add_known(ShelvedProduct product) { return put(std::move(product)); }

ShelvedProduct ProductShelf::add_example(const std::string& name) {
  for (const ShelvedExample& example : shelved_examples()) {
    if (example.name != name) continue;
    if (const auto there = find(example_key(name))) return *there;
    ShelvedProduct product;
    product.file_name = name + ".stl";
    product.argument = product.file_name;
    product.unit = geometry::LengthUnit::kMillimetre;
    product.made_by = make_command(example, product.file_name);
    product.path = new_folder() / product.file_name;
    formats::write_mesh(product.path, records::make_solid({example.kind, example.given}).mesh);
    product = put(std::move(product));
    const std::scoped_lock lock(mutex_);
    examples_[name] = product.key;
    return product;
  }
  throw UsageError("example " + formats::in_quotes(name) + " is not known");
}

std::string ProductShelf::example_key(const std::string& name) const {
  const std::scoped_lock lock(mutex_);
  const auto found = examples_.find(name);
  return found == examples_.end() ? "" : found->second;
}

std::optional<ShelvedProduct> ProductShelf::find(const std::string& key) const {
  const std::scoped_lock lock(mutex_);
  for (const ShelvedProduct& one : products_) {
    if (one.key == key) return one;
  }
  return std::nullopt;
}

ShelvedProduct ProductShelf::open(const std::string& key, const Progress& progress) {
  std::optional<ShelvedProduct> found = find(key);
  if (!found) throw UsageError("product " + formats::in_quotes(key) + " is not there (any more)");
  if (!found->product) found->product = read_product(*found, progress);
  const std::scoped_lock lock(mutex_);
  for (ShelvedProduct& one : products_) {
    if (one.key != key) continue;
    one.product = found->product;
    keep_read(key);
  }
  return *found;
}

std::filesystem::path ProductShelf::own_hand(const std::string& key) const {
  const auto path = own_hands_ ? own_hands_(key) : std::nullopt;
  if (!path) throw UsageError("hand " + formats::in_quotes(key) + " is not there (any more)");
  return *path;
}

workflow::LiveHand ProductShelf::hand(const Holder& holder) {
  workflow::HandChoice choice;
  choice.person = holder.person;
  choice.is_left = holder.is_left;
  std::string key = holder.person ? workflow::person_argument(*holder.person) : "template";
  if (!holder.own_hand.empty()) {
    const std::filesystem::path path = own_hand(holder.own_hand);
    choice.name = path.string();
    // Made again with corrections it is another hand.
    const auto changed = std::filesystem::last_write_time(path).time_since_epoch().count();
    key = holder.own_hand + " " + std::to_string(changed);
  }
  if (holder.is_left) key += " left";
  const std::scoped_lock lock(hands_mutex_);
  for (const auto& [name, hand] : hands_) {
    if (name == key) return hand;
  }
  hands_.emplace_back(key, workflow::prepare_live_hand(choice));
  if (hands_.size() > kMostHands) hands_.erase(hands_.begin());
  return hands_.back().second;
}

}  // namespace palmar::server
