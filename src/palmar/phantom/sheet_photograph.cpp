// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/phantom/sheet_photograph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/hand/creases.h"
#include "palmar/hand/named_postures.h"
#include "palmar/hand/skinning.h"

namespace palmar {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

double spread(RandomStream& random, double most) { return most * (2.0 * random.uniform() - 1.0); }

/// Palm down, still anywhere: z from the paper up.
Vec3 palm_down(const Vec3& p) { return {-p.x(), p.y(), -p.z()}; }

/// Lowest point of some vertices, palm down.
double lowest(const Hand& hand, const std::vector<int>& vertices, const Posture& posture) {
  double low = std::numeric_limits<double>::infinity();
  for (const Vec3& p : pose_skin_vertices(hand, posture, vertices)) low = std::min(low, -p.z());
  return low;
}

}  // namespace

void SheetPhotographOptions::check() const {
  if (!(tilt >= 0.0 && tilt <= 60.0)) {
    throw UsageError(fmt::format("tilt is {} deg; 0 to 60 is allowed", tilt));
  }
  if (!(distance >= 300.0 && distance <= 2000.0)) {
    throw UsageError(fmt::format("distance is {} mm; 300 to 2000 is allowed", distance));
  }
  if (!(pixels_wide >= 300 && pixels_high >= 300 && pixels_wide <= 6000 && pixels_high <= 6000)) {
    throw UsageError(fmt::format("the picture has {} x {} pixels; 300 to 6000 each way is allowed",
                                 pixels_wide, pixels_high));
  }
}

TriangleMesh hand_on_sheet(const Hand& hand, const SheetPhotographOptions& options) {
  options.check();
  RandomStream random(options.seed, 77);
  const auto start = named_posture(hand.skeleton, "spread");
  Posture posture = *start;
  for (const Dof abduction : {Dof::kIndexMcpAbduction, Dof::kMiddleMcpAbduction,
                              Dof::kRingMcpAbduction, Dof::kLittleMcpAbduction}) {
    posture[abduction] =
        (1.0 - options.together) * posture[abduction] * (0.75 + 0.2 * random.uniform()) +
        spread(random, 1.5) * kDegree * (1.0 - options.together);
  }
  posture[Dof::kThumbCmcFlexion] *= 0.3;
  posture[Dof::kThumbCmcAbduction] *= 0.8;
  // The pads lie on the paper; what of palm and thumb would be lower is flattened on it.
  std::vector<int> pads;
  for (std::size_t v = 0; v < hand.segment.size(); ++v) {
    const Segment s = hand.segment[v];
    if (s == Segment::kIndexDistal || s == Segment::kMiddleDistal || s == Segment::kRingDistal ||
        s == Segment::kLittleDistal) {
      pads.push_back(static_cast<int>(v));
    }
  }
  const double paper = lowest(hand, pads, posture);
  TriangleMesh lying{pose_skin(hand, posture), hand.skin.triangles};
  const double turn = spread(random, 8.0) * kDegree, aside = spread(random, 8.0);
  const Eigen::AngleAxisd about(turn, Vec3::UnitZ());
  const Vec3 wrist = palm_down(HandCreases(hand.skin, hand.skeleton).wrist().point);
  const Vec3 edge(aside, -0.5 * options.height + options.wrist_inside, 0.0);
  for (Vec3& p : lying.vertices) {
    p = palm_down(p);
    constexpr double kFlat = 0.3;  // mm
    const Vec3 from_wrist(p.x() - wrist.x(), p.y() - wrist.y(), std::max(p.z() - paper, kFlat));
    p = about * from_wrist + edge;
  }
  return lying;
}

RgbImage photograph_on_sheet(const Hand& hand, const SheetPhotographOptions& options) {
  ColouredMesh lying{hand_on_sheet(hand, options), {}};
  lying.colour.assign(lying.mesh.vertices.size(), options.skin);
  PhotographsOptions stage;
  stage.seed = options.seed;
  stage.distance = options.distance;
  PrintedBoard board;
  board.sheet = options.width;
  board.sheet_height = options.height;
  board.table = options.table;
  RandomStream random(options.seed, 78);
  const double about = 2.0 * std::numbers::pi * random.uniform(), tilt = options.tilt * kDegree;
  const Vec3 target(spread(random, 12.0), spread(random, 12.0), 0.0);
  PhotoShot shot;
  PhotoLens& lens = shot.pose.lens;
  lens.width = options.pixels_wide;
  lens.height = options.pixels_high;
  lens.focal_x = lens.focal_y = options.focal * std::max(lens.width, lens.height);
  lens.centre_x = 0.5 * (lens.width - 1);
  lens.centre_y = 0.5 * (lens.height - 1);
  const Vec3 eye =
      target + options.distance * Vec3(std::sin(tilt) * std::cos(about),
                                       std::sin(tilt) * std::sin(about), std::cos(tilt));
  // The camera held with the sheet's upper edge up, turned a little.
  const Vec3 forward = (target - eye).normalized();
  const double roll = spread(random, 5.0) * kDegree;
  const Vec3 hint(std::cos(roll), std::sin(roll), 0.0);
  const Vec3 right = (hint - hint.dot(forward) * forward).normalized();
  Eigen::Matrix3d turn;
  turn.row(0) = right;
  turn.row(1) = forward.cross(right);
  turn.row(2) = forward;
  const Quat rotation(turn);
  shot.pose.camera_from_world = {rotation, -(rotation * eye)};
  return PhotographsStage(lying, board, stage).take(shot, {}, 0);
}

}  // namespace palmar
