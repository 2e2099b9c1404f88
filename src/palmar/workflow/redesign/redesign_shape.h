// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/workflow/redesign/redesign_outcome.h"
#include "palmar/workflow/redesign/shape_run.h"

namespace palmar::workflow {

struct RedesignShapeOutcome;

/// Redesign 4: the handle shaped anew by few named features (redesign/handle_features.h), chosen
/// for hands that lie at different places on it.
struct RedesignShapeRequest {
  RedesignRequest redesign;
  /// Features that may vary or are set, as shape_variable() reads them; empty: those of
  /// usual_variables().
  std::vector<std::string> vary;
  std::filesystem::path features;  ///< a handle file (records/handle_file.h) that is made as it is
  std::string goal = "peak";       ///< what is made better, as feature_goal() reads it
  ShapeLimits limits;
  HoldSpread spread;
  /// Several uses with weights, as shape_use() reads them, in place of the one that `redesign` is.
  /// The handle is measured in the hold of the first one.
  std::vector<std::string> uses;
  redesign::SearchOptions search{.method = redesign::SearchMethod::kSurface, .evaluations = 40};
  /// Candidate of the search (from 1, as in history.csv) that is made instead of the best one.
  std::optional<int> pick;
  std::optional<double>
      end_radius;        ///< mm, of flat ends; unset: as it is, and 3 mm at least if none is kept
  bool draws = true;     ///< pictures
  bool compares = true;  ///< in the end other hands hold original and redesign
  /// Called when the shape stands and is written, before it is held again; json, comparison and
  /// gains of the outcome are still empty.
  std::function<void(const RedesignShapeOutcome&)> on_shape;

  /// Throws UsageError: setting, value, what is allowed.
  void check() const;
};

/// Features that a search varies unless it is told which.
std::vector<std::string> usual_variables(bool suits_both_hands);

/// What other hands say of the redesign in one of several uses.
struct JudgedUse {
  std::string name;
  double weight = 1.0;  ///< share
  RedesignOutcome outcome;
};

struct RedesignShapeOutcome : RedesignOutcome {
  /// With several uses, all but the first, which is the outcome itself; files in OUT/use-2 ...
  std::vector<JudgedUse> other_uses;
  SearchStory story;
  redesign::HandleShape shape;
  double fit_rms = 0.0;  ///< mm; of the features that are nearest to the original, to it
  redesign::ShapeChange change;
  /// Of a hollow handle: walls over the hollow as it is now, of the redesign and the original, mm.
  std::optional<double> wall, wall_before;
  std::filesystem::path file;            ///< redesign.step, or redesign.stl of a part of a product
  std::optional<double> kept_deviation;  ///< mm; of what a whole product keeps, from the original
  double solid_volume = 0.0;             ///< mm^3, of the solid in redesign.step or handle.step
  int faces = 0, poles = 0;              ///< of that solid; most poles of one surface
};

/// Searches and writes to OUT: redesign.stl; redesign.step (a product that is the handle alone) or
/// handle.step (the handle's part of another one); handle.toml, handle.FCMacro; history.csv,
/// history.svg, choices.svg, shape.json; pictures; gains.csv, gains.svg and what
/// compare_redesigns() writes; with several uses uses-2.svg ... and OUT/use-2 ... with a comparison
/// each. Throws UsageError, InputError, NumericalError if no hand holds the
/// original or no candidate is within the limits, Cancelled.
RedesignShapeOutcome redesign_shape(const RedesignShapeRequest& request,
                                    const Progress& progress = {});

}  // namespace palmar::workflow
