// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "palmar/records/assessment/verdict_text.h"
#include "palmar/study/assessment/verdict.h"

namespace palmar::records {

/// {"sentence", "reasons", "next", "command", "best", "comparisons"}: what stands as "verdict" of a
/// set of assessments. `names`: of the products.
nlohmann::ordered_json verdict_object(const study::SetVerdict& verdict, const VerdictWords& words,
                                      const std::vector<std::string>& names);

/// {"held", "comfort", "strength", "hardest"} of one product.
nlohmann::ordered_json verdict_object(const study::AssessedProduct& product,
                                      const study::ProductVerdict& verdict,
                                      const ProductWords& words);

}  // namespace palmar::records
