// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/study/missing_grasps.h"

#include <fmt/format.h>

#include <algorithm>

namespace palmar::workflow {

std::string missing_grasps(const std::vector<std::int64_t>& numbers) {
  constexpr std::size_t kMost = 10;
  std::string list;
  for (std::size_t i = 0; i < std::min(kMost, numbers.size()); ++i) {
    list += fmt::format("{}{}", i == 0 ? "" : ", ", numbers[i]);
  }
  return fmt::format("finished, but {} grasp{} not in it: {}{}", numbers.size(),
                     numbers.size() == 1 ? " is" : "s are", list,
                     numbers.size() > kMost ? " ..." : "");
}

}  // namespace palmar::workflow
