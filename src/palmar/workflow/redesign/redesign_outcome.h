// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/workflow/redesign/hold_gains.h"
#include "palmar/workflow/redesign/redesign_comparison.h"

namespace palmar::workflow {

/// What every redesign comes to; each has more of its own.
struct RedesignOutcome {
  std::optional<RedesignComparison> comparison;
  std::optional<HoldGains> gains;  ///< of a power grip taken anew by six hands or more
  std::vector<std::string> notes;
  std::string json;  ///< all of it but comparison and gains, one JSON object

  /// Keeps a note and says it to who asked for the redesign.
  void add_note(const RedesignRequest& request, const std::string& text);
  /// Has other hands judge the redesign, where the hold says and elsewhere; writes what
  /// compare_redesigns() does (`figures` go into the report), and gains.csv and gains.svg to OUT.
  /// Throws as that.
  void judge(const RedesignRequest& request, const HeldOriginal& made_for,
             const RedesignedProduct& redesign, const Progress& progress,
             const std::vector<report::StudyFigure>& figures = {});
};

}  // namespace palmar::workflow
