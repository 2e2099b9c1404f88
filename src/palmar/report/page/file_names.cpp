// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/file_names.h"

#include <cctype>

namespace palmar::report {

std::string unique_file_name(const std::string& text, std::set<std::string>& used,
                             FullStops full_stops) {
  constexpr std::size_t kLongest = 80;
  std::string name;
  for (const char c : text) {
    const bool is_kept_stop = c == '.' && full_stops == FullStops::kKept && !name.empty();
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || is_kept_stop;
    name += is_plain ? c : '_';
  }
  if (name.empty()) name = "product";
  if (name.size() > kLongest) name.resize(kLongest);
  std::string unique = name;
  for (int k = 2; !used.insert(unique).second; ++k) unique = name + "_" + std::to_string(k);
  return unique;
}

}  // namespace palmar::report
