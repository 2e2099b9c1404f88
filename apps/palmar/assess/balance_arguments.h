// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli.h"
#include "palmar/grasp/rest/rest_settings.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/workflow/words/person_words.h"

namespace palmar::cli {

/// How firmly the hand grips and whether the grasp comes to rest.
class BalanceArguments {
 public:
  /// Adds --no-balance, --limit-depths, --grip-force-n, --strength-share, --strength-n and --person
  /// to a verb.
  void add_to(CLI::App& verb);
  /// To whose size the hand is scaled, if --person says; throws UsageError.
  std::optional<workflow::PersonOfSize> person() const;
  grasp::RestSettings settings() const;  ///< throws UsageError naming the option

 private:
  grasp::RestSettings settings_;
  bool no_balance_ = false;
  std::string task_ = "usual";
  std::string person_;
};

std::vector<std::string> task_names();  ///< of --task

/// "107 N, 25 % of ... (15 to 23 N in a pinch)": the usual grip force, for help texts.
std::string usual_words();

/// The grip force, and how the grasp came to rest, a line each; empty if it wasn't asked to.
std::string balance_text(const study::Assessment& assessment);
/// How far its forces balance, in one line; empty if nothing came to rest.
std::string rest_text(const study::Assessment& assessment);

}  // namespace palmar::cli
