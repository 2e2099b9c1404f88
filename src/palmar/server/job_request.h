// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/core/language.h"
#include "palmar/geometry/length_unit.h"
#include "palmar/server/hand_request.h"

namespace palmar::server {

/// What takes minutes and so runs by itself: many hands, several designs side by side, a redesign,
/// a person's hand.
enum class JobKind { kStudy, kCompare, kRedesign, kHand };

/// What a client asks for, one JSON object:
///
///     {"kind": "study", "products": ["p1", ...], "populations": ["ansur2_women"], "hands": 12,
///     TASK}
///     {"kind": "compare", "products": ["p1", "p2"], "person": "woman:P5", "left": false, TASK}
///     {"kind": "redesign", "products": ["p1"], "verb": "press" | "region" | "fillet" | "features",
///      "populations", "hands", "largest_depth_mm", "radius_mm": [1, 15], "preview_mm": 8,
///      "vary": ["fillet:face=7=1:6"]}
///     {"kind": "hand", ...}: hand_request.h
///
///     TASK  "grip_force_n" (null: the usual one), "mass_kg", "hold"; "language": "en" | "de" is of
///     all
struct JobRequest {
  JobKind kind = JobKind::kStudy;
  std::vector<std::string> products;  ///< keys on the shelf
  std::vector<std::string> populations;
  int hands = 0;         ///< from each; 0 for populations of given people
  std::string person;    ///< "woman:P5"; "" the template
  std::string own_hand;  ///< in place of it: key of the job that made a hand ("hand:KEY")
  bool is_left = false;
  std::optional<double> grip_force;                 ///< N
  std::optional<double> mass;                       ///< kg
  std::optional<int> hold;                          ///< number in the list of holds
  std::string verb;                                 ///< of a redesign
  std::optional<double> largest_depth;              ///< mm, of press and region
  std::optional<std::pair<double, double>> radius;  ///< mm, of fillet
  std::optional<double> preview_radius;             ///< mm, of fillet; unset: the middle
  std::vector<std::string> vary;                    ///< of features; empty: proposals
  HandRequest hand;                                 ///< of kHand
  Language language = Language::kEnglish;
};

/// In front of the key of a hand that was made here, where a person is named.
inline constexpr std::string_view kOwnHand = "hand:";

/// Throws UsageError naming the member, its value and what is allowed.
JobRequest parse_job_request(std::string_view text);
/// The same back, so that parse_job_request() reads it.
std::string job_request_json(const JobRequest& request);

/// Where the command lines of a job take its products from and put what comes of it.
struct JobPlaces {
  std::vector<std::string> products;         ///< files, in the order of the request
  std::optional<geometry::LengthUnit> unit;  ///< of those that carry none
  std::string folder;  ///< in front of what is written, with '/'; "": the working folder
  std::vector<std::string> sources = {};  ///< files that a person's hand is made from
  std::string hand = {};                  ///< file of JobRequest::own_hand
};

/// One step of a job: a command line of this program, without its name.
struct JobCommand {
  std::vector<std::string> words;
  double share = 1.0;  ///< of the whole job's time, about
};
std::vector<JobCommand> commands_of(const JobRequest& request, const JobPlaces& places);
/// Whether something is looked at before it is started: a study's time, a redesign's preview.
bool is_tried_first(const JobRequest& request);
/// What tells how long a study takes, or makes a redesign's shape with few hands (kJobPreview).
JobCommand estimate_of(const JobRequest& request, const JobPlaces& places);
/// As a person would type it.
std::string command_text(const JobCommand& command);

/// Where things are in a job's folder.
std::filesystem::path job_report(JobKind kind);   ///< the page
std::filesystem::path job_results(JobKind kind);  ///< the folder with files for other programs
inline constexpr const char* kJobStore = "study.palmar";
inline constexpr const char* kJobPreview = "preview";  ///< folder of a redesign's

}  // namespace palmar::server
