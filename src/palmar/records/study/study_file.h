// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palmar/records/product/made_product.h"
#include "palmar/study/study_plan.h"
#include "palmar/study/study_run.h"

namespace palmar::records {

/// A population as asked for: by one of the three.
struct PopulationRequest {
  std::string preset;  ///< name of a built-in one
  std::string file;    ///< population file (records/population/population_file.h)
  std::string
      table;  ///< given hands: a table of subjects (records/population/dimension_table_file.h)
  population::SamplingOptions sampling;  ///< of a table nothing: every subject is a hand
  bool has_seed = false;                 ///< else sampling.seed follows the study's
  std::string where;  ///< "study.toml:7: ", put in front of messages; may be empty
};

/// A population in one word: "xie2014", "folder/people.toml" (a population file), "measured.csv"
/// (given hands).
PopulationRequest population_request(const std::string& words);

/// One or more products as asked for: a file or a solid, in all its sizes.
struct ProductRequest {
  std::string name;     ///< "": the file's stem, or kind and first value
  std::string file;     ///< mesh or CAD file, "made: ...", or "" for `made`
  std::string written;  ///< the same as the study file has it; "": as in `file`
  std::optional<geometry::LengthUnit> unit;  ///< of the file
  MadeProduct made;
  std::vector<double> sizes = {1.0};
  study::StudyProduct held;  ///< at, axis, mass, posture_of
  std::string where;
};

/// A study as asked for in a file or on the command line.
struct StudyRequest {
  std::string name = "study", title;
  std::uint64_t seed = 1;
  std::string hand = "template";  ///< "template", or a hand file
  std::vector<PopulationRequest> populations;
  std::vector<population::HandProfile> profiles;
  std::vector<ProductRequest> products;
  std::vector<std::optional<grasp::Grip>> grips;
  std::vector<study::StudySetting> settings;
  std::vector<study::StudyLimit> limits;
  std::string where;  ///< file, or ""
};

/// Reads a study file (docs/using/studies.md has every key). Paths in it start from its folder.
/// Throws InputError naming file, line, section and key, the value with its unit and what is
/// allowed, or the nearest known key.
StudyRequest read_study_file(const std::string& path);

/// What was left out is filled in: the profile "none", the power grip that suits the shape, one
/// setting, in each the usual grip force (grasp/task_force.h). Throws UsageError or
/// InputError.
struct LoadedStudy {
  study::StudyPlan plan;
  study::StudyInputs inputs;
  std::vector<std::string> notes;  ///< for the user: proposed units, cautions of populations, the
                                   ///< grip force that was filled in
};
/// Draws the hands, reads and makes the products. `hand`: the one that `request.hand` names.
LoadedStudy load_study(const StudyRequest& request, std::shared_ptr<const hand::Hand> hand);

/// Throws UsageError if the file of a product of the plan is found, from the working folder or from
/// `folder`, but nowhere as the study began with it.
void check_products(const study::StudyPlan& plan, const std::filesystem::path& folder = {});

/// "auto" (nothing inside) or a grip's name. Throws UsageError naming the nearest.
std::optional<grasp::Grip> asked_grip_named(const std::string& name);

}  // namespace palmar::records
