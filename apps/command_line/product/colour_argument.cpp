// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "product/colour_argument.h"

#include <array>
#include <string_view>
#include <utility>

#include "palmar/core/error.h"

namespace palmar::cli {

geometry::Srgb parse_colour(const std::string& option, const std::string& text) {
  static const std::array<std::pair<std::string_view, geometry::Srgb>, 6> kPens{
      {{"green", geometry::Srgb(0.10F, 0.45F, 0.22F)},
       {"blue", geometry::Srgb(0.12F, 0.18F, 0.60F)},
       {"red", geometry::Srgb(0.75F, 0.10F, 0.12F)},
       {"black", geometry::Srgb(0.10F, 0.10F, 0.10F)},
       {"purple", geometry::Srgb(0.38F, 0.12F, 0.52F)},
       {"orange", geometry::Srgb(0.95F, 0.45F, 0.05F)}}};
  for (const auto& [name, colour] : kPens) {
    if (text == name) return colour;
  }
  const bool is_hex = text.size() == 7 && text[0] == '#' &&
                      text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!is_hex) {
    throw UsageError(option + ": \"" + text +
                     "\" is no colour; green, blue, red, black, purple, orange or #rrggbb is "
                     "required");
  }
  geometry::Srgb colour;
  for (int k = 0; k < 3; ++k) {
    const std::string part = text.substr(static_cast<std::size_t>(1 + 2 * k), 2);
    colour[k] = static_cast<float>(std::stoi(part, nullptr, 16)) / 255.0F;
  }
  return colour;
}

}  // namespace palmar::cli
