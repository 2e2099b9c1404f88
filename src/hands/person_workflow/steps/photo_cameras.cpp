// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/photo_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hands/capture/photo/surface/hand_motion.h"
#include "hands/imaging/distance_transform.h"
#include "hands/person_workflow/steps/photo_lenses.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/geometry/degrees.h"

namespace palmar::person_workflow {
namespace {

/// Lenses of another set are held against these photographs.
void check_lenses(const PosedPhotographs& work) {
  for (std::size_t i = 0; i < work.set.photographs.size(); ++i) {
    const person_records::PhotoFile& file = work.set.photographs[i];
    const auto found = work.lenses.find(file.camera);
    if (found == work.lenses.end()) {
      throw InputError(fmt::format("{}: the lens of camera \"{}\" isn't among those given",
                                   file.path.string(), file.camera));
    }
    const capture::PhotoLens& lens = found->second.lens;
    if (work.seen[i].width != lens.width || work.seen[i].height != lens.height) {
      throw InputError(fmt::format(
          "{}: {} x {} pixels; the lens given for camera {} is for {} x {}", file.path.string(),
          work.seen[i].width, work.seen[i].height, file.camera, lens.width, lens.height));
    }
  }
}

/// Names of photographs, the first few.
std::string some_names(const person_records::PhotoSet& set, const std::vector<std::size_t>& which) {
  std::string text;
  constexpr std::size_t kMost = 4;
  for (std::size_t i = 0; i < std::min(kMost, which.size()); ++i) {
    text += (i > 0 ? ", " : "") + set.photographs[which[i]].path.filename().string();
  }
  return text + (which.size() > kMost ? ", ..." : "");
}

double typical_sharpness(const std::vector<person_records::BoardSighting>& seen) {
  std::vector<double> sharpness;
  for (const person_records::BoardSighting& one : seen) sharpness.push_back(one.sharpness);
  const auto middle = sharpness.begin() + static_cast<long>(sharpness.size() / 2);
  std::nth_element(sharpness.begin(), middle, sharpness.end());
  return *middle;
}

/// Blur is why a board isn't seen, rather than what covers it.
void refuse_blurred(const std::string& folder,
                    const std::vector<person_records::BoardSighting>& seen) {
  constexpr std::size_t kFewCorners = 8;
  const auto lost = std::count_if(
      seen.begin(), seen.end(),
      [](const person_records::BoardSighting& one) { return one.corners.size() < kFewCorners; });
  // Noise alone makes steps of some hundredths of the range.
  constexpr double kBlurred = 0.1;
  const double typical = typical_sharpness(seen);
  if (2 * lost <= static_cast<long>(seen.size()) || typical > kBlurred) return;
  throw InputError(fmt::format(
      "{}: the photographs are blurred, or empty: edges are spread over {:.0f} pixels or more, and "
      "the board isn't seen in {} of {}",
      folder, 1.0 / std::max(typical, 0.01), lost, seen.size()));
}

void find_poses(PosedPhotographs& work, const std::string& folder) {
  constexpr double kBlurred = 0.12;
  const double typical = typical_sharpness(work.seen);
  std::vector<std::size_t> lost, blurred;
  for (std::size_t i = 0; i < work.set.photographs.size(); ++i) {
    const capture::PhotoLens& lens = work.lenses.at(work.set.photographs[i].camera).lens;
    std::optional<capture::BoardPose> pose = capture::find_board_pose(lens, work.seen[i].corners);
    constexpr double kWorst = 2.0;  // pixels
    if (pose && pose->rms > kWorst) pose.reset();
    if (pose) {
      work.used.push_back(i);
    } else {
      lost.push_back(i);
    }
    work.pose.push_back(pose);
  }
  const std::size_t count = work.set.photographs.size();
  if (2 * lost.size() > count) {
    throw InputError(fmt::format(
        "{}: the board isn't seen in {} of {} photographs ({}): it is covered, blurred, or another "
        "than {} x {} squares with 5 x 5 markers",
        folder, lost.size(), count, some_names(work.set, lost), work.set.board.squares,
        work.set.board.squares));
  }
  if (!lost.empty()) {
    work.warnings.push_back(
        fmt::format("the board isn't seen in {} of {} photographs, which are "
                    "left out: {}",
                    lost.size(), count, some_names(work.set, lost)));
  }
  for (const std::size_t i : work.used) {
    if (work.seen[i].sharpness < std::min(kBlurred, 0.6 * typical)) blurred.push_back(i);
  }
  if (!blurred.empty()) {
    work.warnings.push_back(fmt::format("{} photographs are blurred: {}", blurred.size(),
                                        some_names(work.set, blurred)));
  }
}

void read_photographs(PosedPhotographs& work, const Progress& progress) {
  work.photographs.resize(work.used.size());
  progress.update(0.0, "reading photographs");
  parallel_for(static_cast<int>(work.used.size()), [&](int n) {
    progress.throw_if_cancelled();
    const auto k = static_cast<std::size_t>(n);
    const std::size_t i = work.used[k];
    const person_records::PhotoFile& file = work.set.photographs[i];
    capture::Photograph& photograph = work.photographs[k];
    photograph.name = file.path.filename().string();
    photograph.image = formats::read_texture(formats::read_file(file.path), file.path.string());
    photograph.camera = {work.lenses.at(file.camera).lens, work.pose[i]->camera_from_world};
    photograph.position = file.position;
  });
}

/// How the hand moved from position to position, from points of its skin.
capture::HandMotion find_motion(const std::vector<capture::Photograph>& photographs,
                                const capture::PhotoModelOptions& options,
                                const Progress& progress) {
  const Vec3 middle = options.box.center();
  const int reduction = capture::reduction_for(photographs, middle, options.pixel);
  std::vector<person_records::MatchPicture> pictures(photographs.size());
  std::vector<capture::PhotoCamera> cameras(photographs.size());
  std::vector<int> positions;
  capture::PhotoMaskOptions mask_options = options.mask;
  mask_options.grow = 0.0;
  progress.update(0.0, "looking for motion of the hand");
  parallel_for(static_cast<int>(photographs.size()), [&](int i) {
    progress.throw_if_cancelled();
    const auto p = static_cast<std::size_t>(i);
    const capture::PhotoView view = capture::make_view(photographs[p], reduction);
    capture::PhotoMask mask =
        capture::mask_hand(view, options.box, options.board_half, mask_options);
    cameras[p] = view.camera;
    imaging::VolumeGrid grid;
    grid.size = {view.width(), view.height(), 1};
    constexpr double kRim = 3.0;  // pixels; outlines belong to another point in every picture
    person_records::MatchPicture& picture = pictures[p];
    picture = {view.width(), view.height(), {}, imaging::eroded(grid, mask.inside, kRim)};
    for (const float grey : view.grey) picture.grey.push_back(static_cast<std::uint8_t>(grey));
  });
  for (const capture::Photograph& photograph : photographs)
    positions.push_back(photograph.position);
  std::vector<std::array<int, 2>> pairs;
  constexpr double kWidest = 36.0;  // deg; beyond, points of the skin don't look alike
  for (std::size_t a = 0; a < photographs.size(); ++a) {
    for (std::size_t b = a + 1; b < photographs.size(); ++b) {
      const Vec3 one = (cameras[a].centre() - middle).normalized();
      const Vec3 other = (cameras[b].centre() - middle).normalized();
      if (one.dot(other) > std::cos(kWidest * geometry::kDegree)) {
        pairs.push_back({static_cast<int>(a), static_cast<int>(b)});
      }
    }
  }
  const capture::PointMatches matches =
      person_records::match_points(pictures, pairs, part_of(progress, 0.2, 0.8));
  return capture::fit_hand_motion(cameras, positions, matches);
}

void note_motion(PosedPhotographs& work, const capture::HandMotion& motion) {
  constexpr double kFarShift = 2.0, kFarTurn = 1.0;  // mm, deg
  constexpr int kFewTracks = 60;
  if (motion.tracks < kFewTracks) {
    work.warnings.push_back(
        fmt::format("only {} points of the skin could be followed from position to position: "
                    "whether the hand moved can't be determined",
                    motion.tracks));
  } else if (motion.largest_shift > kFarShift ||
             motion.largest_turn > kFarTurn * geometry::kDegree) {
    work.warnings.push_back(fmt::format(
        "the hand moved by up to {:.1f} mm and {:.1f} deg between positions; this was corrected, a "
        "repeat with the wrist supported is better",
        motion.largest_shift, motion.largest_turn / geometry::kDegree));
  }
}

}  // namespace

PosedPhotographs pose_photographs(const std::string& folder, const person_records::PhotoSet& set,
                                  const std::optional<person_records::PhotoLenses>& lenses,
                                  const capture::PhotoModelOptions& model,
                                  const PhotoMeshOptions& options, const Progress& progress) {
  PosedPhotographs work;
  work.set = set;
  work.seen = person_records::find_boards(set.board, person_records::paths_of(set),
                                          part_of(progress, 0.0, 0.33));
  refuse_blurred(folder, work.seen);
  work.lenses_were_given = lenses.has_value();
  if (lenses) {
    work.lenses = *lenses;
    check_lenses(work);
  } else {
    work.lenses = calibrate_lenses(set, work.seen, folder);
    work.warnings = loose_lenses(
        work.lenses,
        with_setting_names(
            "photographs of the board tilted every way give better ones (setting \"lenses\")",
            options.setting_names));
  }
  find_poses(work, folder);
  read_photographs(work, part_of(progress, 0.33, 0.5));
  if (!options.looks_for_motion) return work;
  if (!set.is_described) {
    work.warnings.emplace_back(
        "which photographs were taken together isn't said (names like p3_c2.jpg, or photos.json), "
        "so motion of the hand between them isn't corrected");
    return work;
  }
  work.motion = find_motion(work.photographs, model, part_of(progress, 0.5, 1.0));
  note_motion(work, work.motion);
  if (work.motion.is_applied) {
    for (capture::Photograph& photograph : work.photographs) {
      photograph.camera.camera_from_world =
          photograph.camera.camera_from_world *
          work.motion.board_from_hand[static_cast<std::size_t>(photograph.position)];
    }
  }
  return work;
}

}  // namespace palmar::person_workflow
