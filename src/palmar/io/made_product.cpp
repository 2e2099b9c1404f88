// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/io/made_product.h"

#include <algorithm>
#include <functional>
#include <map>

#include "palmar/core/error.h"
#include "palmar/io/text_scan.h"
#include "palmar/product/primitives.h"

namespace palmar {
namespace {

constexpr std::string_view kMade = "made: ";

struct Kind {
  std::vector<std::string> lengths;
  /// Lengths by name; those that aren't in the map keep their default.
  std::function<Product(const std::map<std::string, double>&, double size)> make;
};

const std::map<std::string, Kind>& kinds() {
  const auto apply = [](const std::map<std::string, double>& given, const std::string& name,
                        double size, double& value) {
    const auto found = given.find(name);
    value = size * (found == given.end() ? value : found->second);
  };
  static const std::map<std::string, Kind> all = {
      {"cylinder",
       {{"diameter_mm", "length_mm"},
        [apply](const auto& given, double size) {
          CylinderProductOptions o;
          apply(given, "diameter_mm", size, o.diameter);
          apply(given, "length_mm", size, o.length);
          return make_cylinder_product(o);
        }}},
      {"prism",
       {{"width_mm", "depth_mm", "length_mm", "fillet_mm"},
        [apply](const auto& given, double size) {
          PrismProductOptions o;
          apply(given, "width_mm", size, o.width);
          apply(given, "depth_mm", size, o.depth);
          apply(given, "length_mm", size, o.length);
          apply(given, "fillet_mm", size, o.fillet_radius);
          return make_prism_product(o);
        }}},
      {"sphere",
       {{"diameter_mm"},
        [apply](const auto& given, double size) {
          SphereProductOptions o;
          apply(given, "diameter_mm", size, o.diameter);
          return make_sphere_product(o);
        }}},
      {"ellipsoid", {{"x_mm", "y_mm", "z_mm"}, [apply](const auto& given, double size) {
                       EllipsoidProductOptions o;
                       apply(given, "x_mm", size, o.diameters.x());
                       apply(given, "y_mm", size, o.diameters.y());
                       apply(given, "z_mm", size, o.diameters.z());
                       return make_ellipsoid_product(o);
                     }}}};
  return all;
}

}  // namespace

const std::vector<std::string>& made_kinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, kind] : kinds()) all.push_back(name);
    return all;
  }();
  return names;
}

std::vector<std::string> made_lengths(const std::string& kind) {
  const auto found = kinds().find(kind);
  return found == kinds().end() ? std::vector<std::string>() : found->second.lengths;
}

std::string words_of(const MadeProduct& product) {
  std::string words = std::string(kMade) + product.kind;
  for (const auto& [name, value] : product.length) words += " " + name + "=" + shortest(value);
  return words;
}

bool is_made(const std::string& words) { return words.rfind(kMade, 0) == 0; }

MadeProduct made_from(const std::string& words) {
  TextScanner scanner(std::string_view(words).substr(std::min(kMade.size(), words.size())));
  const auto kind = scanner.next_word();
  MadeProduct product{kind ? std::string(*kind) : "", {}};
  if (!is_made(words) || made_lengths(product.kind).empty()) {
    throw InputError(in_quotes(words) + " tells no solid that Palmar makes");
  }
  while (const auto word = scanner.next_word()) {
    const std::size_t equals = word->find('=');
    const auto value = equals == word->npos ? std::nullopt : parse_double(word->substr(equals + 1));
    if (!value) throw InputError(in_quotes(words) + ": " + in_quotes(*word) + " is no length");
    product.length.emplace_back(word->substr(0, equals), *value);
  }
  return product;
}

Product make_solid(const MadeProduct& product, double size) {
  const auto found = kinds().find(product.kind);
  if (found == kinds().end()) {
    throw UsageError("product of kind " + in_quotes(product.kind) + " can't be made");
  }
  const std::map<std::string, double> given(product.length.begin(), product.length.end());
  Product solid = found->second.make(given, size);
  solid.source = words_of(product);
  return solid;
}

}  // namespace palmar
