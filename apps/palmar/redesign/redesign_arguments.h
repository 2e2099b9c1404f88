// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli.h"
#include "palmar/records/study/study_file.h"
#include "palmar/study/statistics/study_results.h"

namespace palmar::cli {

// The verbs of `palmar redesign`; each adds itself to the noun.
void add_redesign_press_command(CLI::App& noun, Context& context);     ///< press
void add_redesign_region_command(CLI::App& noun, Context& context);    ///< region
void add_redesign_feature_commands(CLI::App& noun, Context& context);  ///< fillet, features

/// What every redesign starts from, as typed: a product, the hands that hold it, where to write.
struct RedesignArguments {
  std::string product;  ///< file, or "made: prism width_mm=35 ..."
  std::string unit, hand, at, axis;
  std::vector<std::string> populations = {"xie2014"};
  std::vector<std::string> grips;
  int hands = 30;
  /// "kept": redesigns are held in the posture in which the same hand holds the original (Xie 2014,
  /// 5.5.3); "new": grasped by themselves.
  std::string posture = "kept";
  double grip_force = 0.0;  ///< N; 0: as closed. Original and redesigns at the same force: "new"
  std::string out;          ///< folder

  void add_to(CLI::App& verb);
};

/// The original in the hands.
struct HeldOriginal {
  LoadedStudy study;                 ///< with one product, one condition
  std::vector<StudyRecord> records;  ///< with fields, ascending
  const Product& product() const { return study.inputs.products.front(); }
  RecordSource source() const;  ///< of `records`, which must outlive it
};
/// Loads, draws and grasps. Throws NumericalError if no hand holds the product: no answer.
HeldOriginal grasp_original(const RedesignArguments& arguments, const Context& context,
                            const Progress& progress);

/// A redesigned product with what is to be said of it.
struct RedesignedProduct {
  Product product;
  std::string name;  ///< "pressed", "fillet 8 mm"
  std::string file;  ///< that was written
};

/// The last step of every redesign: the same hands hold the original and the redesigns. Writes
/// OUT/redesign.palmar and OUT/report/, prints the paired comparison (with --json: returned as a
/// JSON text to be put under "comparison", nothing printed).
std::string compare_redesigns(const RedesignArguments& arguments, const HeldOriginal& original,
                              const std::vector<RedesignedProduct>& redesigns,
                              const Context& context, const Progress& progress);

/// Results of all hands with one more product beside the original: what a search evaluates. Product
/// 0 is the original, 1 the candidate, whose records come without fields, and without indices
/// unless asked for.
StudyResults assess_candidate(const RedesignArguments& arguments, const HeldOriginal& original,
                              const Product& candidate, bool with_indices,
                              const Progress& progress);

}  // namespace palmar::cli
