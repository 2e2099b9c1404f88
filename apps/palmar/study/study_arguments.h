// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli.h"
#include "grasp/hold_arguments.h"
#include "palmar/study/study_plan.h"
#include "palmar/workflow/study/study.h"

namespace palmar::cli {

// The verbs of `palmar study`; each adds itself to the noun.
void add_study_run_commands(CLI::App& noun, Context& context);    ///< plan, run, resume
void add_study_shard_commands(CLI::App& noun, Context& context);  ///< merge, status
void add_study_export_command(CLI::App& noun, Context& context);  ///< export
void add_study_submit_command(CLI::App& noun, Context& context);  ///< submit

/// What is to be studied, as typed: a study file, or products and population without one.
class StudyArguments {
 public:
  /// Adds FILE and --product, --population, --hands ... to a verb.
  void add_to(CLI::App& verb);
  /// Throws UsageError, InputError.
  records::StudyRequest request(const Context& context) const;

 private:
  std::string file_, unit_, task_ = "usual";
  std::vector<std::string> populations_;
  HoldArguments holds_;
  workflow::QuickStudy quick_;
};

/// "2/4". Throws UsageError naming --shard.
study::StudyShard parse_shard(const std::string& text);

/// "30 hands x 4 products x 2 grips = 240 grasps"; only what there are several of, hands always.
std::string study_size_text(const study::StudyPlan& plan);

/// Time for people: "12 s", "5 min", "2.5 h".
std::string duration_text(double seconds);

}  // namespace palmar::cli
