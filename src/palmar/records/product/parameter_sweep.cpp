// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/parameter_sweep.h"

#include <cmath>
#include <set>

#include "palmar/core/error.h"
#include "palmar/formats/text_scan.h"
#include "palmar/product/parametric_kinds.h"

namespace palmar::records {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (;;) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end == text.npos ? text.npos : end - begin));
    if (end == text.npos) return parts;
    begin = end + 1;
  }
}

std::string with_unit(double value, const std::string& parameter) {
  const std::string unit = product::unit_of_parameter(parameter);
  return formats::shortest(value) + (unit.empty() ? "" : " " + unit);
}

double number_of(const std::string& parameter, const std::string& whole, const std::string& part) {
  const auto value = formats::parse_double(part);
  if (value && std::isfinite(*value)) return *value;
  throw UsageError(parameter + " is " + formats::in_quotes(whole) +
                   "; a number, from:to:step (25:60:2.5) or a list (30,35,45) is allowed");
}

[[noreturn]] void refuse_count(const std::string& what, double count) {
  throw UsageError(what + " makes " + formats::shortest(count) + " variants; up to " +
                   std::to_string(kMostVariants) + " are allowed");
}

}  // namespace

std::vector<double> sweep_values(const std::string& parameter, double from, double to,
                                 double step) {
  if (!(step > 0.0)) {
    throw UsageError(parameter + ": the sweep's step is " + with_unit(step, parameter) +
                     "; above 0 is allowed");
  }
  if (!(to >= from)) {
    throw UsageError(parameter + ": the sweep goes from " + with_unit(from, parameter) +
                     " down to " + with_unit(to, parameter) +
                     "; from the smaller to the larger "
                     "is allowed");
  }
  const double count = std::floor((to - from) / step + 1e-9) + 1.0;
  if (count > static_cast<double>(kMostVariants)) refuse_count(parameter, count);
  std::vector<double> values;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    // 25 + 3 * 0.1 is to be called 25.3.
    values.push_back(std::round((from + i * step) * 1e9) / 1e9);
  }
  return values;
}

std::vector<double> parse_sweep(const std::string& parameter, const std::string& text) {
  std::vector<double> numbers;
  const bool is_range = text.find(':') != text.npos;
  for (const std::string& part : split(text, is_range ? ':' : ',')) {
    numbers.push_back(number_of(parameter, text, part));
  }
  if (!is_range) {
    if (std::set<double>(numbers.begin(), numbers.end()).size() < numbers.size()) {
      throw UsageError(parameter + " is " + formats::in_quotes(text) + ": a value appears twice");
    }
    return numbers;
  }
  if (numbers.size() != 3) number_of(parameter, text, "");
  return sweep_values(parameter, numbers[0], numbers[1], numbers[2]);
}

std::vector<MadeVariant> variants_of(const MadeSweep& sweep) {
  std::vector<MadeVariant> variants = {{{sweep.kind, {}}, ""}};
  for (const auto& [name, values] : sweep.given) {
    const double count = static_cast<double>(variants.size()) * static_cast<double>(values.size());
    if (count > static_cast<double>(kMostVariants)) refuse_count(sweep.kind, count);
    std::vector<MadeVariant> next;
    for (const MadeVariant& before : variants) {
      for (const double value : values) {
        MadeVariant one = before;
        one.product.given.emplace_back(name, value);
        if (values.size() > 1) {
          const std::string what = title_of({"", {{name, value}}}).substr(1);
          one.suffix += (one.suffix.empty() ? "" : " ") + what;
        }
        next.push_back(std::move(one));
      }
    }
    variants = std::move(next);
  }
  for (const MadeVariant& one : variants) {
    product::complete_values(product::parametric_kind(one.product.kind), one.product.given);
  }
  return variants;
}

}  // namespace palmar::records
