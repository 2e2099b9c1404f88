// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/joints/measured_joints.h"
#include "hands/capture/scan/scanned_hand.h"
#include "hands/capture/skin_errors.h"

namespace palmar::capture {

/// One scan and what was found in it.
struct RecordedScan {
  hand::ScanPosture posture{};
  std::string title;       ///< where it is from, for people
  std::string laterality;  ///< tag of the image: "R", "L" or ""
  ScanSurfaces surfaces;
  bool was_kept = false;  ///< taken over from an earlier run
};

/// The new hand beside the scanned one on what both hold (grasp_contact.h).
struct ScanContact {
  std::string product;  ///< where it is from, for people
  double range = 0.0;   ///< within which skin counts as touching, mm
  ContactOverlap overlap;
};

/// All that became of a person's scans, for tables and report.
struct ScanRecord {
  std::vector<RecordedScan> scans;  ///< the reference first
  std::map<hand::ScanPosture, std::vector<BoneMotion>> motions;
  MeasuredJoints joints;
  ScannedHand made;
  std::optional<ScanContact> contact;  ///< if a product was given
  std::vector<std::string> notes;      ///< of every step: sentences
};

/// Why no hand came of scans.
struct ScanRefusal {
  std::string step;  ///< that failed: "surfaces", "bones", "motions", "joints", "hand", "contact"
  std::string posture;  ///< whose scan it was about; empty: all
  std::string message;  ///< the cause: a sentence
};

/// Mean of the bones' errors in one posture, as a row of Xie 2014, tables 2-2 to 2-4, has it.
struct ErrorRow {
  hand::ScanPosture posture{};
  std::string bones;                       ///< "proximal phalanges II-V", "thumb_metacarpal"
  int count = 0;                           ///< bones in it
  double icp = 0.0, single_axis = 0.0;     ///< mm
  std::optional<double> interpolated_cmc;  ///< mm; thumb only
};

/// Rows in the order of the postures: the thumb bone by bone, fingers II to V by kind of phalanx.
/// The metacarpals II to V, carpals and forearm, which don't move with a finger, have none.
std::vector<ErrorRow> error_rows(const std::vector<BoneError>& errors);

}  // namespace palmar::capture
