// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli.h"
#include "palmar/records/study/study_file.h"
#include "palmar/study/study_plan.h"

namespace palmar::cli {

// The verbs of `palmar study`; each adds itself to the noun.
void add_study_run_commands(CLI::App& noun, Context& context);    ///< plan, run, resume
void add_study_shard_commands(CLI::App& noun, Context& context);  ///< merge, status
void add_study_export_command(CLI::App& noun, Context& context);  ///< export
void add_study_submit_command(CLI::App& noun, Context& context);  ///< submit

/// What is to be studied, as typed: a study file, or products and population without one.
struct StudyArguments {
  std::string file;
  std::vector<std::string> products, populations, profiles, grips;
  std::string unit, hand;
  int hands = 0;  ///< 0: not given

  /// Adds FILE and --product, --population, --hands ... to a verb.
  void add_to(CLI::App& verb);
  /// Throws UsageError, InputError.
  StudyRequest request(const Context& context) const;
  /// The same, drawn and loaded; notes go to stderr.
  LoadedStudy load(const Context& context) const;
};

/// "2/4". Throws UsageError naming --shard.
StudyShard parse_shard(const std::string& text);

/// "30 hands x 4 products x 2 grips = 240 grasps"; only what there are several of, hands always.
std::string study_size_text(const StudyPlan& plan);

/// "finished, but 2 grasps are not in it: 3, 5": of a damaged store.
std::string missing_text(const std::vector<std::int64_t>& numbers);

/// Time for people: "12 s", "5 min", "2.5 h".
std::string duration_text(double seconds);

/// What a few grasps of the study took here, on one thread, and what the whole will take.
struct StudyEstimate {
  double seconds_once = 0.0;       ///< to read what is needed and find the places of the grips
  double seconds_per_hand = 0.0;   ///< all grasps of one hand, on one thread
  double memory_once = 0.0;        ///< MB
  double memory_per_thread = 0.0;  ///< MB
  int sample = 0;                  ///< grasps that were run for it

  double seconds(std::int64_t hands, int threads) const;
  double memory(int threads) const;  ///< MB
};
StudyEstimate estimate_study(const LoadedStudy& study, const Progress& progress);

}  // namespace palmar::cli
