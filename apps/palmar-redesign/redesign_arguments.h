// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli.h"
#include "grasp/hold_arguments.h"
#include "palmar/workflow/redesign/redesign_outcome.h"
#include "palmar/workflow/redesign/redesign_request.h"

namespace palmar::cli {

// The verbs of `palmar redesign`; each adds itself to the noun.
void add_redesign_press_command(CLI::App& noun, Context& context);     ///< press
void add_redesign_region_command(CLI::App& noun, Context& context);    ///< region
void add_redesign_feature_commands(CLI::App& noun, Context& context);  ///< fillet, features
void add_redesign_shape_command(CLI::App& noun, Context& context);     ///< shape

/// What every redesign starts from, as typed.
struct RedesignArguments {
  workflow::RedesignRequest request;  ///< with what needs no reading
  std::string unit, at, axis, out;
  std::vector<std::string> grips;
  HoldArguments holds;
  std::string language = "en";
  std::string posture = name_of(workflow::RedesignRequest{}.posture);

  void add_to(CLI::App& verb);
  /// Read; notes go to stderr. Throws UsageError.
  workflow::RedesignRequest read(const Context& context) const;
};

/// --keep-box, which may be repeated.
void add_kept_boxes(CLI::App& verb, std::vector<std::string>& texts);
/// Read. Throws UsageError.
std::vector<Box3> kept_boxes(const std::vector<std::string>& texts);

/// What hands say of a redesign in another use than the first.
struct NamedOutcome {
  std::string name;
  double weight = 0.0;  ///< share
  const workflow::RedesignOutcome& outcome;
};

/// What a redesign prints in the end: comparison and gains in words and where they were written, or
/// with --json the one object, with both in it; those of `others`, too.
void print_redesign(const workflow::RedesignOutcome& outcome, const Context& context,
                    const std::vector<NamedOutcome>& others = {});

}  // namespace palmar::cli
