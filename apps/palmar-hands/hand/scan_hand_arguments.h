// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cli.h"
#include "hands/person_workflow/steps/scan_hand.h"

namespace palmar::cli {

/// Options of making a hand of surfaces, whether they were scanned or photographed.
class ScanHandArguments {
 public:
  /// `work_help`: what the folder of --work holds.
  void add_to(CLI::App& verb, const std::string& work_help);
  person_workflow::ScanHandOptions options() const;  ///< throws UsageError naming the option

 private:
  person_workflow::ScanHandOptions options_;
  std::string side_, language_ = "en", crease_ = "green", dot_ = "blue";
  bool no_report_ = false;
};

/// "FILE=POSTURE" of --posture, also in short (natural, flexed, spread). Throws UsageError.
std::map<std::string, hand::ScanPosture> parse_file_postures(
    const std::vector<std::string>& stated);

/// What a user sees of a hand that was made: notes, sizes or JSON, files.
void print_scanned_hand(const person_workflow::ScanHandOutcome& outcome, const std::string& out,
                        const Context& context);

}  // namespace palmar::cli
