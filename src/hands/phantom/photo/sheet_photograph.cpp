// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/photo/sheet_photograph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hands/phantom/person/person_random.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"

namespace palmar::phantom {
namespace {

constexpr double kCardGap = 9.0;  // mm, between the hand and the card

/// Palm down, still anywhere: z from the paper up.
Vec3 palm_down(const Vec3& p) { return {-p.x(), p.y(), -p.z()}; }

/// What is printed on a card: a chip, a band and lines of writing. 0 to 255, square about its
/// middle.
std::vector<std::uint8_t> card_print(int pixels) {
  std::vector<std::uint8_t> grey(static_cast<std::size_t>(pixels) * pixels);
  for (int y = 0; y < pixels; ++y) {
    for (int x = 0; x < pixels; ++x) {
      const double u = (x + 0.5) / pixels - 0.5, v = 0.5 - (y + 0.5) / pixels;
      double ink = 0.12 * std::max(0.0, 0.5 + u + v);  // a shade across
      if (std::abs(u + 0.28) < 0.07 && std::abs(v - 0.05) < 0.05) ink = 0.7;
      if (v > 0.16 && v < 0.23) ink = 0.45;
      if (std::abs(v + 0.12) < 0.012 || std::abs(v + 0.19) < 0.012) {
        ink = std::sin(160.0 * u) > 0.0 ? 0.85 : ink;
      }
      grey[static_cast<std::size_t>(y) * pixels + x] =
          static_cast<std::uint8_t>(255.0 * (1.0 - ink));
    }
  }
  return grey;
}

PrintedBoard board_of(const SheetPhotographOptions& options) {
  PrintedBoard board;
  board.sheet = options.width;
  board.sheet_height = options.height;
  board.table = options.table;
  if (options.is_plain) board.grain = 0.0;
  if (options.is_card) {
    board.pixels = 400;
    board.grey = card_print(board.pixels);
    board.edge = options.width;
    board.corner = options.corner;
    board.thickness = options.thickness;
    board.paper = options.card;
  }
  return board;
}

/// Where a card lies from the wrist's middle: beside the broadest part of the palm's lower half, on
/// the little finger's side.
double beside(const geometry::TriangleMesh& lying, const Vec3& wrist, hand::Side side) {
  double reach = 0.0;
  const double towards = side == hand::Side::kRight ? 1.0 : -1.0;
  for (const Vec3& p : lying.vertices) {
    if (p.y() < wrist.y() - 10.0 || p.y() > wrist.y() + 70.0) continue;
    reach = std::max(reach, towards * (p.x() - wrist.x()));
  }
  return towards * reach;
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
  if (!(focal >= 0.4 && focal <= 4.0)) {
    throw UsageError(
        fmt::format("focal length is {} of the longer side; 0.4 to 4 is allowed", focal));
  }
  if (!(k1 >= -0.1 && k1 <= 0.1)) {
    throw UsageError(fmt::format("k1 is {}; -0.1 to 0.1 is allowed", k1));
  }
}

geometry::TriangleMesh hand_on_sheet(const SpreadHand& hand,
                                     const SheetPhotographOptions& options) {
  options.check();
  RandomStream random(options.seed, 77);
  // The pads lie on the paper; what of palm and thumb would be lower is flattened on it.
  constexpr double kPad = 18.0;  // mm, from the tip
  double paper = std::numeric_limits<double>::infinity();
  for (const Vec3& v : hand.skin.vertices) {
    for (const Vec3& tip : hand.fingertips) {
      if ((v - tip).squaredNorm() < kPad * kPad) paper = std::min(paper, -v.z());
    }
  }
  geometry::TriangleMesh lying = hand.skin;
  const double turn = about_zero(random, 8.0) * geometry::kDegree, aside = about_zero(random, 8.0);
  const Eigen::AngleAxisd about(turn, Vec3::UnitZ());
  const Vec3 wrist = palm_down(hand.wrist);
  for (Vec3& p : lying.vertices) {
    p = palm_down(p);
    constexpr double kFlat = 0.3;  // mm
    p = about * Vec3(p.x() - wrist.x(), p.y() - wrist.y(), std::max(p.z() - paper, kFlat));
  }
  Vec3 edge(aside, -0.5 * options.height + options.wrist_inside, 0.0);
  if (options.is_card) {
    const double reach = beside(lying, Vec3::Zero(), hand.side);
    const double towards = reach < 0.0 ? -1.0 : 1.0;
    edge.x() = -(reach + towards * (kCardGap + 0.25 * aside + 0.5 * options.width));
  }
  for (Vec3& p : lying.vertices) p += edge;
  return lying;
}

geometry::RgbImage photograph_on_sheet(const SpreadHand& hand,
                                       const SheetPhotographOptions& options) {
  geometry::ColouredMesh lying{hand_on_sheet(hand, options), {}};
  lying.colour.assign(lying.mesh.vertices.size(), options.skin);
  PhotographsOptions stage;
  stage.seed = options.seed;
  stage.distance = options.distance;
  RandomStream random(options.seed, 78);
  const double about = 2.0 * std::numbers::pi * random.uniform(),
               tilt = options.tilt * geometry::kDegree;
  const double aim_y = about_zero(random, 12.0),
               aim_x = about_zero(random, 12.0);  // in one order everywhere
  Vec3 target(aim_x, aim_y, 0.0);
  if (options.is_card) {
    // Between the card and the hand.
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Vec3& v : lying.mesh.vertices) {
      if (v.y() < -0.5 * options.height) continue;
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    const double half = 0.5 * options.width;
    target.x() += 0.5 * (std::min(low.x(), -half) + std::max(high.x(), half));
    target.y() += 0.5 * (low.y() + high.y());
  }
  PhotoShot shot;
  capture::PhotoLens& lens = shot.pose.lens;
  lens.width = options.pixels_wide;
  lens.height = options.pixels_high;
  lens.focal_x = lens.focal_y = options.focal * std::max(lens.width, lens.height);
  lens.centre_x = 0.5 * (lens.width - 1);
  lens.centre_y = 0.5 * (lens.height - 1);
  lens.k1 = options.k1;
  const Vec3 eye =
      target + options.distance * Vec3(std::sin(tilt) * std::cos(about),
                                       std::sin(tilt) * std::sin(about), std::cos(tilt));
  // The camera held with the sheet's upper edge up, turned a little.
  const Vec3 forward = (target - eye).normalized();
  const double roll = about_zero(random, 5.0) * geometry::kDegree;
  const Vec3 hint(std::cos(roll), std::sin(roll), 0.0);
  const Vec3 right = (hint - hint.dot(forward) * forward).normalized();
  Eigen::Matrix3d turn;
  turn.row(0) = right;
  turn.row(1) = forward.cross(right);
  turn.row(2) = forward;
  const Quat rotation(turn);
  shot.pose.camera_from_world = {rotation, -(rotation * eye)};
  return PhotographsStage(lying, board_of(options), stage).take(shot, {}, 0);
}

}  // namespace palmar::phantom
