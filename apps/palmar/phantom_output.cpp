// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "phantom_output.h"

#include <fmt/format.h>

namespace palmar::cli {

void print_made_scans(const Context& context, const std::string& subject, Side side,
                      const nlohmann::ordered_json& scans, const std::string& text,
                      const std::string& truth) {
  if (!context.common.json) return print(text + fmt::format("truth: {}\n", truth));
  const nlohmann::ordered_json json = {{"subject", subject},
                                       {"seed", context.common.seed},
                                       {"side", std::string(name_of(side))},
                                       {"scans", scans},
                                       {"truth", truth}};
  print(json.dump(2) + "\n");
}

}  // namespace palmar::cli
