// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cli.h"
#include "hand/scan_surface.h"
#include "palmar/capture/mri/scan_posture.h"
#include "palmar/capture/scan/skin_marks.h"
#include "palmar/report/scan/hand_scan_report.h"

namespace palmar::cli {

/// Options of making a hand of surfaces, whether they were scanned or photographed.
struct ScanHandArguments {
  std::string out, work, model = "template", name, side, marks, truth;
  std::string crease = "green", dot = "blue";
  double dot_mm = SkinMarkOptions{}.dot_diameter;
  bool no_report = false;

  void add_to(CLI::App& verb);
  /// Throws UsageError naming the option.
  SkinMarkOptions inks() const;
  /// Refuses what can't be written to and a file of marks that can't be read, before the long work.
  /// `work` is made if there is a report.
  void check_outputs(const std::string& work_folder) const;
};

/// Which file or folder of `paths` shows which posture: as `told` ("FILE=POSTURE") or as its name
/// tells, also in short (natural, flexed, spread); a single one the reference. `what` they are
/// stands in messages: "scan". Throws UsageError, also if none is the reference.
std::map<ScanPosture, std::string> files_by_posture(const std::vector<std::string>& paths,
                                                    const std::vector<std::string>& told,
                                                    const std::string& what);

/// Surfaces to a hand: the file that `arguments` name, the report in `work`, and what a user sees
/// of it. `shown`: surfaces in mm with the marks that were found on them.
void make_hand_of_surfaces(const ScanHandArguments& arguments, const std::string& work,
                           const std::map<ScanPosture, ShownScan>& shown,
                           const std::vector<std::string>& notes, const Context& context,
                           const Progress& progress);

}  // namespace palmar::cli
