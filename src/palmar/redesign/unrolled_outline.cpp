// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/unrolled_outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/grasp/power/grip_axis.h"
#include "palmar/redesign/handle_section.h"

namespace palmar::redesign {
namespace {

constexpr double kAlike = 0.1;      // mm between sections: milling marks are as large
constexpr double kOnSide = 0.2;     // mm; outlines lie on the side to the mesh's chordal error
constexpr double kFlat = 5.0;       // mm; shorter straight parts are facets of a round side
constexpr double kStraight = 0.01;  // rad; facets that turn less are one flat side

/// A closed outline measured from its first corner.
class Tape {
 public:
  explicit Tape(std::vector<Eigen::Vector2d> outline) : outline_(std::move(outline)) {
    way_.assign(outline_.size() + 1, 0.0);
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      way_[i + 1] = way_[i] + (corner(i + 1) - outline_[i]).norm();
    }
  }
  double length() const { return way_.back(); }

  /// Way of the nearest point; `distance` to it.
  double way_of(const Eigen::Vector2d& x, double& distance) const {
    double best = 0.0, least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const Eigen::Vector2d step = corner(i + 1) - outline_[i];
      const double squared = step.squaredNorm();
      if (!(squared > 0.0)) continue;
      const double share = std::clamp((x - outline_[i]).dot(step) / squared, 0.0, 1.0);
      const double d = (outline_[i] + share * step - x).squaredNorm();
      if (d < least) {
        least = d;
        best = way_[i] + share * std::sqrt(squared);
      }
    }
    distance = std::sqrt(least);
    return best;
  }

  Eigen::Vector2d at(double way) const {
    way = std::fmod(std::fmod(way, length()) + length(), length());
    const auto next = std::upper_bound(way_.begin(), way_.end(), way);
    const auto i = static_cast<std::size_t>(next - way_.begin()) - 1;
    const double step = way_[i + 1] - way_[i];
    return outline_[i] +
           (step > 0.0 ? (way - way_[i]) / step : 0.0) * (corner(i + 1) - outline_[i]);
  }

  /// Ways at which straight parts begin and end.
  std::vector<double> flat_ends() const {
    const std::size_t n = outline_.size();
    std::vector<std::size_t> bends;
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d in = (outline_[i] - corner(i + n - 1)).normalized();
      const Eigen::Vector2d out = (corner(i + 1) - outline_[i]).normalized();
      if (std::abs(in.x() * out.y() - in.y() * out.x()) > kStraight) bends.push_back(i);
    }
    std::vector<double> ends;
    for (std::size_t k = 0; k < bends.size(); ++k) {
      const double begin = way_[bends[k]];
      double end = way_[bends[(k + 1) % bends.size()]];
      if (end <= begin) end += length();
      if (end - begin < kFlat) continue;
      ends.push_back(begin);
      ends.push_back(std::fmod(end, length()));
    }
    std::sort(ends.begin(), ends.end());
    return ends;
  }

 private:
  Eigen::Vector2d corner(std::size_t i) const { return outline_[i % outline_.size()]; }
  std::vector<Eigen::Vector2d> outline_;
  std::vector<double> way_;
};

/// The middle of the widest gap between ways round a tape.
double widest_gap(std::vector<double> ways, double length) {
  std::sort(ways.begin(), ways.end());
  double cut = 0.0, widest = -1.0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const double next = i + 1 < ways.size() ? ways[i + 1] : ways[0] + length;
    if (next - ways[i] > widest) {
      widest = next - ways[i];
      cut = std::fmod(0.5 * (ways[i] + next), length);
    }
  }
  return cut;
}

/// A closed line on the sheet: one piece, or those between the sheet's cut.
void add_pieces(const std::string& name, const std::vector<Eigen::Vector2d>& round, double width,
                std::vector<UnrolledLine>& lines) {
  const std::size_t n = round.size();
  const auto jumps = [&](std::size_t i) {
    return std::abs(round[(i + 1) % n].x() - round[i].x()) > 0.5 * width;
  };
  std::size_t first = 0;
  while (first < n && !jumps(first)) ++first;
  if (first == n) {
    lines.push_back({name, round, true});
    return;
  }
  UnrolledLine piece{name, {}, false};
  for (std::size_t k = 1; k <= n; ++k) {
    const std::size_t i = (first + k) % n;
    piece.points.push_back(round[i]);
    if (!jumps(i)) continue;
    // To the border, and on from the other one.
    const Eigen::Vector2d& a = round[i];
    Eigen::Vector2d b = round[(i + 1) % n];
    const double border = a.x() > b.x() ? width : 0.0;
    b.x() += a.x() > b.x() ? width : -width;
    const double share = (border - a.x()) / (b.x() - a.x());
    const double y = a.y() + share * (b.y() - a.y());
    piece.points.emplace_back(border, y);
    lines.push_back(std::move(piece));
    piece = {name, {Eigen::Vector2d(width - border, y)}, false};
  }
  // The last piece begins where the first did: at the first jump.
  if (piece.points.size() > 1) {
    lines.push_back(std::move(piece));
  } else if (!lines.empty()) {
    for (auto line = lines.rbegin(); line != lines.rend() && line->name == name; ++line) {
      if ((line->points.front() - round[(first + 1) % n]).norm() < 1e-12) {
        line->points.insert(line->points.begin(), piece.points.front());
        break;
      }
    }
  }
}

}  // namespace

UnrolledOutline unroll(const geometry::TriangleMesh& product,
                       const std::vector<ContactRegion>& regions, std::optional<Vec3> axis) {
  UnrolledOutline sheet;
  sheet.axis = axis ? *axis : Vec3(grasp::principal_frame(product).axes.col(0));
  Eigen::Index largest = 0;
  sheet.axis.cwiseAbs().maxCoeff(&largest);
  if (sheet.axis[largest] < 0.0) sheet.axis = -sheet.axis;
  const Vec3 e1 = sheet.axis.unitOrthogonal(), e2 = sheet.axis.cross(e1);
  sheet.low = std::numeric_limits<double>::infinity();
  sheet.high = -sheet.low;
  for (const Vec3& x : product.vertices) {
    sheet.low = std::min(sheet.low, x.dot(sheet.axis));
    sheet.high = std::max(sheet.high, x.dot(sheet.axis));
  }
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const ContactRegion& region : regions) {
    for (const RegionPatch& patch : region.patches) {
      for (const RegionOutline& outline : patch.outline) {
        for (const Vec3& x : outline.points) {
          first = std::min(first, x.dot(sheet.axis));
          last = std::max(last, x.dot(sheet.axis));
        }
      }
    }
  }
  if (!(last > first)) throw UsageError("unrolled outline: the region is empty");
  const double inset = 0.01 * (sheet.high - sheet.low);
  first = std::clamp(first, sheet.low + inset, sheet.high - inset);
  last = std::clamp(last, sheet.low + inset, sheet.high - inset);
  const auto section_at = [&](double s) {
    return HandleSection(product, s * sheet.axis, sheet.axis, e1, e2).outline();
  };
  const Tape tape(section_at(0.5 * (first + last)));
  for (int k = 0; k <= 6; ++k) {
    for (const Eigen::Vector2d& x : section_at(first + (last - first) * k / 6.0)) {
      double off = 0.0;
      tape.way_of(x, off);
      sheet.section_change = std::max(sheet.section_change, off);
    }
  }
  if (sheet.section_change > kAlike) {
    throw UsageError(fmt::format(
        "unrolled outline: sections of the product differ by {:.2g} mm over the length of the "
        "region; only a cylinder or a prism (up to {} mm) can be unrolled true to length",
        sheet.section_change, kAlike));
  }
  sheet.width = tape.length();
  std::vector<std::pair<std::string, std::vector<Eigen::Vector2d>>> rounds;
  std::vector<double> ways;
  for (const ContactRegion& region : regions) {
    for (const RegionPatch& patch : region.patches) {
      for (const RegionOutline& outline : patch.outline) {
        rounds.push_back({region.title, {}});
        for (const Vec3& x : outline.points) {
          double off = 0.0;
          const double way = tape.way_of(Eigen::Vector2d(x.dot(e1), x.dot(e2)), off);
          if (off > kOnSide) {
            throw UsageError(fmt::format(
                "unrolled outline: an outline of \"{}\" leaves the side of the product at ({:.1f}, "
                "{:.1f}, {:.1f}) mm",
                region.title, x.x(), x.y(), x.z()));
          }
          ways.push_back(way);
          rounds.back().second.emplace_back(way, x.dot(sheet.axis));
        }
      }
    }
  }
  const double cut = widest_gap(ways, sheet.width);
  const auto shifted = [&](double way) { return way >= cut ? way - cut : way - cut + sheet.width; };
  for (auto& [name, round] : rounds) {
    for (Eigen::Vector2d& p : round) p.x() = shifted(p.x());
    add_pieces(name, round, sheet.width, sheet.lines);
  }
  for (const double way : tape.flat_ends()) sheet.edges.push_back(shifted(way));
  std::sort(sheet.edges.begin(), sheet.edges.end());
  const Eigen::Vector2d at = tape.at(cut);
  sheet.cut = at.x() * e1 + at.y() * e2 + 0.5 * (sheet.low + sheet.high) * sheet.axis;
  return sheet;
}

}  // namespace palmar::redesign
