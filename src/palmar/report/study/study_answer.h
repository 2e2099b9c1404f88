// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/core/language.h"
#include "palmar/study/statistics/study_comparison.h"
#include "palmar/study/statistics/study_results.h"

namespace palmar::report {

/// What a study comes to, for the first of its conditions: which product presses less at its
/// hardest place, by how much, in how many hands, at which grip force; or that there is no
/// difference that matters, and why.
struct StudyAnswer {
  std::string tone =
      "fair";  ///< "good": there is an answer; "fair": not yet; "bad": nobody holds it
  std::string sentence;
  std::vector<std::string> reasons;
  std::string next;                  ///< what to do next, to be followed by the command
  std::string command;               ///< for it; empty if there is none
  std::optional<int> better, worse;  ///< products; nothing for one product
  std::vector<double> changes;       ///< by hand, of the peak: better over worse, less 1
};

struct StudyAnswerOptions {
  Language language = Language::kEnglish;
  study::ComparisonOptions comparison;
  std::string store;    ///< of the study, for commands; may be empty
  std::string command;  ///< of the redesign that the study is of; may be empty
};

StudyAnswer study_answer(const study::StudyResults& results,
                         const StudyAnswerOptions& options = {});

}  // namespace palmar::report
