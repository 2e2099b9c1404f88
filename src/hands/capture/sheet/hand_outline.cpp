// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/hand_outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hands/capture/picture_vectors.h"
#include "hands/capture/sheet/finger_axis.h"
#include "hands/capture/sheet/line_fit.h"
#include "hands/capture/sheet/outline_curve.h"
#include "palmar/core/error.h"

namespace palmar::capture {
namespace {

constexpr double kAboveWeb = 1.5;                          // mm; as HandCreases draws base creases
constexpr double kIndexSlope = 0.12, kLittleSlope = 0.35;  // of base creases, likewise
constexpr double kWebToHead = 17.0 / 185.0;  // webs lie 14 to 20 mm beyond the metacarpals' heads
                                             // in a hand of 185 mm (Bugbee & Botte 1993)

/// The contour's farthest point along a direction near a tip.
Vec2 farthest(const std::vector<Vec2>& curve, std::size_t near, const Vec2& direction,
              double cell) {
  const auto reach = static_cast<std::size_t>(15.0 / cell);
  const std::size_t from = near > reach ? near - reach : 0;
  Vec2 best = curve[near];
  for (std::size_t i = from; i < std::min(curve.size(), near + reach); ++i) {
    if (curve[i].dot(direction) > best.dot(direction)) best = curve[i];
  }
  return best;
}

/// The palm's middle: the centre of the largest circle in the outline and the grid.
Vec2 palm_middle(const SheetGrid& grid, const imaging::VoxelMask& mask, const Vec2& otherwise) {
  imaging::VoxelMask outside(mask.size());
  for (std::size_t p = 0; p < mask.size(); ++p) outside[p] = mask[p] == 0 ? 1 : 0;
  const std::vector<float> depth = imaging::distance_transform(grid.volume(), outside);
  Vec2 middle = otherwise;
  double deepest = 0.0;
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      if (mask[grid.at(x, y)] == 0) continue;
      // Not where the forearm meets the edge: nothing is outside of the grid.
      const Vec2 here = grid.sheet(x, y);
      const double d = std::min<double>(depth[grid.at(x, y)], grid.to_edge(here));
      if (d <= deepest) continue;
      deepest = d;
      middle = here;
    }
  }
  return middle;
}

/// The curve from the thumb to the little finger, with its tips and webs.
struct ThumbFirst {
  std::vector<Vec2> curve;
  OutlineExtremes extremes;
};

ThumbFirst thumb_first(std::vector<Vec2> curve, OutlineExtremes extremes, const Vec2& up) {
  const auto high = [&](const Extreme& e) { return curve[e.at].dot(up); };
  if (high(extremes.webs.front()) > high(extremes.webs.back())) {
    // The thumb's web is the one nearest to the wrist.
    std::reverse(curve.begin(), curve.end());
    for (auto* const list : {&extremes.tips, &extremes.webs}) {
      std::reverse(list->begin(), list->end());
      for (Extreme& e : *list) e.at = curve.size() - 1 - e.at;
    }
  }
  return {std::move(curve), std::move(extremes)};
}

}  // namespace

void HandOutlineOptions::check() const {
  if (!(wrist >= 0.0 && wrist <= 80.0)) {
    throw UsageError(
        fmt::format("the wrist crease is {} mm inside the edge; 0 to 80 is allowed", wrist));
  }
}

HandOutline measure_outline(const SheetGrid& grid, const imaging::VoxelMask& mask,
                            const SheetView& sheet, const OutlineProportions& proportions,
                            const std::string& name, const HandOutlineOptions& options) {
  options.check();
  const OpenOutline open = open_outline(grid, outline_of(grid, mask), name);
  const Vec2 forearm = 0.5 * (open.from + open.to);
  const Vec2 middle = palm_middle(grid, mask, forearm);
  const Vec2 up = (middle - forearm).normalized();
  OutlineExtremes extremes = extremes_of(open.curve, middle);
  if (extremes.tips.size() != 5 || extremes.webs.size() != 4) {
    throw InputError(fmt::format(
        "{}: {} fingertips and {} webs between them are seen in the outline; 5 and 4 are needed: "
        "spread all fingers and the thumb so that paper or table shows between them down to the "
        "webs, no ring or sleeve there",
        name, extremes.tips.size(), extremes.webs.size()));
  }
  const ThumbFirst found = thumb_first(open.curve, std::move(extremes), up);
  const std::vector<Vec2>& curve = found.curve;
  const auto tip_of = [&](std::size_t f) { return found.extremes.tips[f].at; };
  const auto web_of = [&](std::size_t k) { return curve[found.extremes.webs[k].at]; };
  HandOutline result;
  const bool thumb_left = cross2(up, curve[tip_of(0)] - middle) > 0.0;
  result.is_right = thumb_left != options.palm_up;
  result.contour = curve;

  // From above, at the height that each place has.
  const double length0 = (curve[tip_of(2)] - forearm).norm();
  const auto raised = [&](const Vec2& p, double share) { return sheet.raised(p, share * length0); };
  const double web_height = proportions.web_height, palm_height = proportions.palm_height;
  for (std::size_t k = 0; k < 4; ++k) {
    result.seen_web[k] = web_of(k);
    result.web[k] = raised(web_of(k), web_height);
  }
  const SoftMask skin(grid, mask);
  const auto size = [&](double share) { return 1.0 - share * length0 / sheet.eye.z(); };
  std::array<FingerAxis, 5> axis;
  std::array<double, 5> foot{};  // where the base crease crosses the axis, along it, as seen
  for (std::size_t f = 0; f < 5; ++f) {
    OutlineFinger& finger = result.finger[f];
    const Vec2 seen_tip = curve[tip_of(f)];
    if (f == 0) {
      // The thumb's middle line: its last phalanx and a little more.
      const double last = proportions.segment[0][1] * length0;
      const Vec2 towards = (seen_tip - web_of(0)).normalized();
      axis[0] = axis_of(skin, seen_tip, seen_tip - 1.3 * last * towards);
    } else if (f == 1 || f == 4) {
      const Vec2 web = web_of(f == 1 ? 1 : 3);
      const Vec2 towards = (seen_tip - web).normalized();
      Vec2 aside(-towards.y(), towards.x());
      if (aside.dot(web - web_of(2)) < 0.0) aside = -aside;
      axis[f] = axis_of(skin, seen_tip, web + 8.0 * aside);
    } else {
      axis[f] = axis_of(skin, seen_tip, 0.5 * (web_of(f - 1) + web_of(f)));
    }
    finger.direction = axis[f].direction;
    const Vec2 across(-finger.direction.y(), finger.direction.x());
    const Vec2 tip = farthest(curve, tip_of(f), finger.direction, grid.cell);
    finger.seen_tip = tip;
    finger.tip = raised(tip, proportions.finger_height[f]);
    if (f == 0) {
      finger.seen_base = axis[0].at(axis[0].along(web_of(0)));
      finger.base = raised(finger.seen_base, web_height);
      finger.length = (finger.tip - finger.base).norm();
      continue;  // lies on its side: how wide it is isn't seen
    }
    if (f == 1 || f == 4) {
      const Vec2 web = web_of(f == 1 ? 1 : 3);
      foot[f] = axis[f].along(web) + kAboveWeb -
                (f == 1 ? kIndexSlope : kLittleSlope) * axis[f].aside(web);
    } else {
      const Vec2 a = web_of(f - 1), b = web_of(f);
      const double share = axis[f].aside(a) / std::max(1e-9, axis[f].aside(a) + axis[f].aside(b));
      foot[f] = (1.0 - share) * axis[f].along(a) + share * axis[f].along(b) + kAboveWeb;
    }
    finger.seen_base = axis[f].at(foot[f]);
    finger.base = raised(finger.seen_base, web_height);
    finger.length = (finger.tip - finger.base).norm();
    const double seen = axis[f].along(tip) - foot[f];
    double done = 0.0;
    for (std::size_t s = 0; s < 3; ++s) {
      const double share = proportions.segment[f][s], half_way = done + 0.5 * share;
      const Vec2 c = axis[f].at(foot[f] + half_way * seen);
      const double height =
          web_height + (proportions.finger_height[f] - web_height) * std::min(1.0, half_way);
      finger.width[s] = (skin.reach(c, across, 25.0) + skin.reach(c, -across, 25.0)) * size(height);
      done += share;
    }
  }
  // The wrist: at the edge, or so far inside of it, where the hand lies on the paper.
  result.wrist = forearm + (options.wrist - grid.to_edge(forearm) - grid.border) * up;
  result.hand_length = (result.finger[2].tip - result.wrist).norm();

  // Over the heads of metacarpals II and V.
  const auto head = [&](std::size_t f) {
    return axis[f].at(foot[f] - kAboveWeb - kWebToHead * length0);
  };
  const Vec2 head2 = head(1), head5 = head(4), across = (head2 - head5).normalized();
  const double between = (head2 - head5).norm();
  const double beyond2 = skin.reach(head2, across, 0.6 * between),
               beyond5 = skin.reach(head5, -across, 0.6 * between);
  if (beyond2 < 0.45 * between && beyond5 < 0.45 * between) {
    result.hand_width = (between + beyond2 + beyond5) * size(palm_height);
  }
  return result;
}

}  // namespace palmar::capture
