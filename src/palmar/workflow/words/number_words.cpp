// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/words/number_words.h"

#include <charconv>
#include <cmath>

#include "palmar/core/error.h"

namespace palmar::workflow {
namespace {

double parse_number(const std::string& what, const std::string& text) {
  if (text.empty()) throw UsageError(what + ": a number is missing");
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    throw UsageError(what + ": \"" + text + "\" is not a number");
  }
  return value;
}

}  // namespace

std::vector<double> parse_list(const std::string& what, const std::string& text) {
  std::vector<double> values;
  std::size_t start = 0;
  while (true) {
    const std::size_t comma = text.find(',', start);
    values.push_back(parse_number(what, text.substr(start, comma - start)));
    if (comma == std::string::npos) return values;
    start = comma + 1;
  }
}

Vec3 parse_vector(const std::string& what, const std::string& text) {
  const std::vector<double> values = parse_list(what, text);
  if (values.size() != 3) {
    throw UsageError(what + ": \"" + text + "\" has " + std::to_string(values.size()) +
                     " numbers; three, x,y,z, are needed");
  }
  return {values[0], values[1], values[2]};
}

Vec3 parse_direction(const std::string& what, const std::string& text) {
  const bool has_sign = !text.empty() && (text[0] == '+' || text[0] == '-');
  const std::string axis = has_sign ? text.substr(1) : text;
  if (axis == "x" || axis == "y" || axis == "z") {
    const Vec3 unit = Vec3::Unit(axis[0] - 'x');
    return text[0] == '-' ? Vec3(-unit) : unit;
  }
  if (text.find(',') == text.npos) {
    throw UsageError(what + ": \"" + text +
                     "\" is no direction; an axis (+x, -x, +y ...) or three numbers x,y,z are "
                     "required");
  }
  const Vec3 direction = parse_vector(what, text);
  if (!(direction.norm() > 0.0)) {
    throw UsageError(what + ": " + text + " has no direction; not all may be 0");
  }
  return direction;
}

}  // namespace palmar::workflow
