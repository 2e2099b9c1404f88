// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "phantom/phantom_output.h"

#include <fmt/format.h>

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"

namespace palmar::cli {

void print_made_scans(const Context& context, const person_workflow::PhantomPerson& person,
                      const nlohmann::ordered_json& scans, const std::string& text) {
  if (!context.common.json) return print(text + fmt::format("truth: {}\n", person.truth));
  const nlohmann::ordered_json json = {{"subject", person.name},
                                       {"seed", context.common.seed},
                                       {"side", std::string(name_of(person.side))},
                                       {"scans", scans},
                                       {"truth", person.truth}};
  print(json.dump(2) + "\n");
}

std::vector<hand::ScanPosture> chosen_postures(const std::vector<std::string>& names) {
  std::vector<std::string> all;
  for (int p = 0; p < hand::kScanPostureCount; ++p) {
    all.emplace_back(name_of(static_cast<hand::ScanPosture>(p)));
  }
  std::vector<hand::ScanPosture> chosen;
  for (const std::string& name : names) {
    const auto found = std::find(all.begin(), all.end(), name);
    if (found == all.end()) {
      const std::string nearest = nearest_name(name, all);
      throw UsageError(fmt::format("--posture: \"{}\" is no posture; {}", name,
                                   nearest.empty()
                                       ? fmt::format("{} are allowed", fmt::join(all, ", "))
                                       : "did you mean " + nearest + "?"));
    }
    chosen.push_back(static_cast<hand::ScanPosture>(found - all.begin()));
  }
  return chosen;
}

}  // namespace palmar::cli
