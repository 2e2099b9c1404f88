// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/records/study/study_file.h"
#include "palmar/study/study_plan.h"
#include "palmar/study/study_record.h"
#include "palmar/workflow/note/note.h"
#include "palmar/workflow/study/study_estimate.h"

namespace palmar::workflow {

/// A study without a study file: products and who holds them, by name.
struct QuickStudy {
  static constexpr int kMostHands = 1'000'000;

  std::vector<std::string> products;         ///< mesh or CAD files; at least one
  std::optional<geometry::LengthUnit> unit;  ///< of files that carry none
  /// Built-in populations, population files (.toml) or tables of given hands.
  std::vector<std::string> populations = {"xie2014"};
  int hands = 0;                      ///< to draw from each population; 0: 30
  std::vector<std::string> profiles;  ///< "none", "reduced_range", ...; empty: none
  std::vector<std::string> grips;     ///< "auto", "tripod", ...; empty: auto
  grasp::HoldRequest holding;         ///< by which part and how all products are held
  std::string hand;                   ///< that is scaled; "": the template
  double mass = 0.0;                  ///< of every product, kg, up to 100; 0: no load
  grasp::HandTask task = grasp::HandTask::kUsual;
  std::optional<double> turn;  ///< kTurn: with that torque about the grip axis, N m
  // How firmly; at most one. None: the usual grip force, the same for all hands and products.
  std::optional<double> grip_force;      ///< N
  std::optional<double> strength_share;  ///< of each person's own grip strength
  bool limit_depths = false;             ///< as firm as closing to the limit depths made it
  void check() const;                    ///< throws UsageError: setting, value, what is allowed
};
/// Throws UsageError also for names that aren't known. read_study_file() reads one from a file.
records::StudyRequest study_of(const QuickStudy& quick);

/// Draws the hands, reads hand and products. Throws UsageError, InputError naming the file.
records::LoadedStudy load_study(const records::StudyRequest& request, const NoteSink& note);

/// What would run.
struct StudyPlanRequest {
  records::StudyRequest study;
  bool has_sample = true;  ///< a few grasps are measured for the estimate
  NoteSink note = {};      ///< proposed units, cautions of populations
};
struct StudyPlanOutcome {
  study::StudyPlan plan;
  int threads = 1;                        ///< that would run it here
  std::optional<StudyEstimate> estimate;  ///< with `has_sample`
};
StudyPlanOutcome plan_study(const StudyPlanRequest& request, const Progress& progress = {});

/// A study, or one shard of it, to be run into a store.
struct StudyRunRequest {
  records::StudyRequest study;
  std::filesystem::path out;  ///< store; "": the study's name in the working folder
  study::StudyShard shard;
  NoteSink note = {};  ///< as above, and where a store goes on
  void check() const;  ///< throws UsageError: setting, value, what is allowed
};
struct StudyRunOutcome {
  study::StudyPlan plan;
  std::filesystem::path store;
  study::StudyShard shard;
  std::int64_t grasps = 0;   ///< of the shard
  std::int64_t run_now = 0;  ///< the others were in the store already
  std::map<study::StudyOutcome, std::int64_t> outcomes;
  std::map<std::string, std::int64_t> reasons;  ///< of failed grasps
  std::string digest;                           ///< of all results
  double seconds = 0.0;                         ///< spent on what was run now
};

/// Runs a study, or goes on where its store is there and of this study. Every finished grasp is
/// kept at once: Cancelled says how many are, and resume_study() goes on. Throws UsageError: a
/// store of another study, shard or program; InputError; OutputError.
StudyRunOutcome run_study(const StudyRunRequest& request, const Progress& progress = {});

/// Goes on with a study that was stopped. Of a finished one nothing is run. Throws as run_study().
StudyRunOutcome resume_study(const std::filesystem::path& store, const NoteSink& note = {},
                             const Progress& progress = {});

}  // namespace palmar::workflow
