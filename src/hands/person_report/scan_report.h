// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/capture/scan/scan_record.h"
#include "palmar/core/language.h"
#include "palmar/core/progress.h"
#include "palmar/hand/person/scan_posture.h"
#include "palmar/report/picture/assessment_pictures.h"

namespace palmar::person_report {

/// "thumb flexion"
std::string plain_words(hand::ScanPosture posture);

/// Pictures of a person's hand made from scans, each from the palm and from the thumb's side:
///
///     hand_palm ...           the new hand, see-through, with its bones
///     error_POSTURE_palm ...  the hand posed as scanned, coloured by its distance to the scan
///     scan_POSTURE_palm ...   what was found in a scan: skin, bones, markers
///
/// When cancelled, those that are finished.
std::vector<report::Picture> scan_pictures(const capture::ScanRecord& record,
                                           const report::PictureOptions& options = {},
                                           const Progress& progress = {});

/// The pictures scan_... alone, of scans that no hand came of: upright by their own bones, or as
/// they lay in the scanner where too few of the palm are known.
std::vector<report::Picture> found_pictures(const capture::ScanRecord& record,
                                            const report::PictureOptions& options = {},
                                            const Progress& progress = {});

/// Writes into `folder`: report.html (works offline: what was scanned, tables 2-2 to 2-5 of Xie
/// 2014 for this person with charts, ranges, dimensions, pictures, notes), scan.json,
/// bone_errors.csv, skin_errors.csv and, with a product, grasp_contact.csv. The page is in
/// `language`, the files are English. Same record, same bytes. Throws OutputError, Cancelled.
void write_scan_report(const std::string& folder, const capture::ScanRecord& record,
                       Language language = Language::kEnglish, const Progress& progress = {});

/// Of scans that no hand came of, writes into `folder` report.html (the step that failed and why,
/// what was found in each scan, pictures, notes) and found.json, and takes away what
/// write_scan_report() left of an earlier run. `record` holds the reference's scan at least;
/// `bones`: how many a hand has. Throws OutputError, Cancelled.
void write_refused_scan_report(const std::string& folder, const capture::ScanRecord& record,
                               const capture::ScanRefusal& refusal, std::size_t bones,
                               Language language = Language::kEnglish,
                               const Progress& progress = {});

}  // namespace palmar::person_report
