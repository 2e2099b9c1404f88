// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/found_creases.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include "palmar/core/error.h"

namespace palmar::capture {
namespace {

constexpr double kBaseReach = 10.0, kWristReach = 18.0, kAside = 28.0;  // mm
constexpr double kBare = 3.5;                                           // mm between two lines
constexpr double kLeastBreadth = 5.0;                                   // mm; a third of a finger's
constexpr double kSpread = 5.0;   // mm: how far off creases are suggested
constexpr double kAlone = 3.0;    // cost of a crease or line without partner
constexpr double kCertain = 3.0;  // times as much of a line right across a finger: nothing else is

struct Ink {
  Vec3 point;  // hand frame
  double weight = 0.0;
  double along = 0.0;  // of its finger, mm
};

/// What is drawn and belongs together.
struct Line {
  std::vector<Ink> ink;
  std::optional<hand::Finger> finger;
  double along = 0.0;    // mean, mm
  double breadth = 0.0;  // across the finger, mm
  std::optional<hand::Segment> crease;
  bool is_no_crease = false;
  std::string labelled_at;  // place of the label that decided
};

/// A crease with what is needed to measure on it.
struct Frame {
  hand::CreasePlane plane;
  Vec3 aside;  // across the finger, unit
};

Frame frame_of(const hand::HandCreases& creases, hand::Segment segment) {
  if (segment == hand::Segment::kPalm) {
    return {creases.wrist(), creases.wrist().normal.cross(Vec3::UnitZ())};
  }
  const hand::Finger finger = *hand::finger_of(segment);
  int node = finger == hand::Finger::kThumb ? 2 : 1;
  for (const auto& s : hand::segments_of(finger)) {
    if (s == segment) break;
    ++node;
  }
  const hand::CreasePlane& plane = creases.proximal_crease(segment);
  return {plane, plane.normal.cross(creases.palmar_direction(finger, node)).normalized()};
}

/// The creases suggested on one finger, base first, and places along it.
class FingerScale {
 public:
  FingerScale(const hand::HandCreases& creases, hand::Finger finger) {
    for (const auto& s : hand::segments_of(finger)) {
      if (!s) continue;
      segment.push_back(*s);
      plane_.push_back(creases.proximal_crease(*s));
      const std::size_t k = plane_.size() - 1;
      place.push_back(k == 0 ? 0.0 : place[k - 1] + (plane_[k].point - plane_[k - 1].point).norm());
    }
  }
  double along(const Vec3& p) const {
    for (std::size_t k = 0; k + 1 < plane_.size(); ++k) {
      const double behind = plane_[k].value(p), before = -plane_[k + 1].value(p);
      if (behind <= 0.0) return place[k] + behind;
      if (before > 0.0) return place[k] + (place[k + 1] - place[k]) * behind / (behind + before);
    }
    return place.back() + plane_.back().value(p);
  }
  std::vector<hand::Segment> segment;
  std::vector<double> place;  // mm from the base crease

 private:
  std::vector<hand::CreasePlane> plane_;
};

/// The finger or wrist whose crease a drawn point may be part of.
struct Owner {
  bool is_wrist = false;
  std::optional<hand::Finger> finger;
};
Owner owner_of(const Vec3& p, const hand::HandCreases& creases) {
  const hand::SkinLabel label = creases.label(p);
  if (label.segment != hand::Segment::kPalm) return {false, hand::finger_of(label.segment)};
  if (std::abs(creases.wrist().value(p)) < kWristReach) return {true, {}};
  Owner owner;
  double nearest = kAside;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const hand::CreasePlane& base = creases.proximal_crease(*hand::segments_of(finger)[0]);
    const double distance = (p - base.point).norm();
    if (std::abs(base.value(p)) > kBaseReach || distance > nearest) continue;
    nearest = distance;
    owner.finger = finger;
  }
  return owner;
}

void measure(Line& line, const hand::HandCreases& creases, const FingerScale& scale) {
  double weights = 0.0, low = 1e9, high = -1e9;
  line.along = 0.0;
  for (const Ink& ink : line.ink) {
    line.along += ink.weight * ink.along;
    weights += ink.weight;
  }
  line.along /= weights;
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < scale.place.size(); ++k) {
    if (std::abs(scale.place[k] - line.along) < std::abs(scale.place[nearest] - line.along)) {
      nearest = k;
    }
  }
  const Frame frame = frame_of(creases, scale.segment[nearest]);
  for (const Ink& ink : line.ink) {
    const double aside = frame.aside.dot(ink.point - frame.plane.point);
    low = std::min(low, aside);
    high = std::max(high, aside);
  }
  line.breadth = high - low;
}

/// Lines of one finger, from its base on.
std::vector<Line> lines_along(std::vector<Ink> ink, hand::Finger finger,
                              const hand::HandCreases& creases) {
  const FingerScale scale(creases, finger);
  for (Ink& one : ink) one.along = scale.along(one.point);
  std::stable_sort(ink.begin(), ink.end(),
                   [](const Ink& a, const Ink& b) { return a.along < b.along; });
  std::vector<Line> lines;
  for (const Ink& one : ink) {
    if (lines.empty() || one.along - lines.back().ink.back().along > kBare) {
      lines.emplace_back();
      lines.back().finger = finger;
    }
    lines.back().ink.push_back(one);
  }
  for (Line& line : lines) measure(line, creases, scale);
  return lines;
}

/// Lines near the wrist; the crease is the nearest to where the joints suggest it of those at least
/// half as broad as the broadest.
std::vector<Line> wrist_lines(std::vector<Ink> ink, const hand::HandCreases& creases) {
  const Frame frame = frame_of(creases, hand::Segment::kPalm);
  for (Ink& one : ink) one.along = frame.plane.value(one.point);
  std::stable_sort(ink.begin(), ink.end(),
                   [](const Ink& a, const Ink& b) { return a.along < b.along; });
  std::vector<Line> lines;
  double broadest = 0.0;
  for (const Ink& one : ink) {
    if (lines.empty() || one.along - lines.back().ink.back().along > kBare) lines.emplace_back();
    lines.back().ink.push_back(one);
  }
  for (Line& line : lines) {
    double low = 1e9, high = -1e9, weights = 0.0;
    for (const Ink& one : line.ink) {
      const double aside = frame.aside.dot(one.point - frame.plane.point);
      low = std::min(low, aside);
      high = std::max(high, aside);
      line.along += one.weight * one.along;
      weights += one.weight;
    }
    line.along /= weights;
    line.breadth = high - low;
    broadest = std::max(broadest, line.breadth);
  }
  Line* nearest = nullptr;
  for (Line& line : lines) {
    if (line.breadth < 0.5 * broadest) continue;
    if (nearest == nullptr || std::abs(line.along) < std::abs(nearest->along)) nearest = &line;
  }
  if (nearest != nullptr) nearest->crease = hand::Segment::kPalm;
  return lines;
}

/// All that is drawn: wrist, fingers, then what lies near no crease.
std::vector<Line> gather(const SkinMarks& marks, const geometry::Rigid3& hand_from_scan,
                         const hand::HandCreases& creases) {
  std::vector<Ink> of_wrist;
  std::array<std::vector<Ink>, hand::kFingerCount> of_finger;
  std::vector<Line> strays, lines;
  for (const InkLine& piece : marks.lines) {
    Line stray;
    for (std::size_t k = 0; k < piece.point.size(); ++k) {
      const Ink ink{hand_from_scan * piece.point[k], piece.weight[k]};
      const Owner owner = owner_of(ink.point, creases);
      std::vector<Ink>& where = owner.is_wrist ? of_wrist
                                : owner.finger ? of_finger[static_cast<int>(*owner.finger)]
                                               : stray.ink;
      where.push_back(ink);
    }
    if (!stray.ink.empty()) strays.push_back(std::move(stray));
  }
  lines = wrist_lines(std::move(of_wrist), creases);
  for (int f = 0; f < hand::kFingerCount; ++f) {
    for (Line& line : lines_along(std::move(of_finger[f]), static_cast<hand::Finger>(f), creases)) {
      lines.push_back(std::move(line));
    }
  }
  for (Line& line : strays) lines.push_back(std::move(line));
  return lines;
}

/// What a hand wrote about lines that were found.
void take_labels(const SkinMarks& marks, const geometry::Rigid3& hand_from_scan,
                 std::vector<Line>& lines) {
  for (const CreaseLabel& label : marks.crease_labels) {
    const Vec3 p = hand_from_scan * label.point;
    Line* nearest = nullptr;
    double least = std::numeric_limits<double>::max();
    for (Line& line : lines) {
      for (const Ink& ink : line.ink) {
        const double d = (ink.point - p).norm();
        if (d >= least) continue;
        least = d;
        nearest = &line;
      }
    }
    if (nearest == nullptr) continue;
    const bool is_same = nearest->is_no_crease ? !label.crease : nearest->crease == label.crease;
    if (!nearest->labelled_at.empty() && !is_same) {
      throw InputError(fmt::format("{}: {} gives the same line another name", label.place,
                                   nearest->labelled_at));
    }
    nearest->labelled_at = label.place;
    nearest->crease = label.crease;
    nearest->is_no_crease = !label.crease;
  }
  for (const InkLine& added : marks.added_lines) {
    Line line;
    line.crease = added.crease;
    line.labelled_at = "added";
    for (std::size_t k = 0; k < added.point.size(); ++k) {
      line.ink.push_back({hand_from_scan * added.point[k], added.weight[k]});
    }
    lines.push_back(std::move(line));
  }
}

/// Mean of the ink.
Vec3 mean_of(const Line& line) {
  Vec3 mean = Vec3::Zero();
  for (const Ink& ink : line.ink) mean += ink.point / static_cast<double>(line.ink.size());
  return mean;
}

/// A point of the ink, nearest to its middle.
Vec3 middle_of(const Line& line) {
  const Vec3 mean = mean_of(line);
  return std::min_element(line.ink.begin(), line.ink.end(),
                          [&](const Ink& a, const Ink& b) {
                            return (a.point - mean).squaredNorm() < (b.point - mean).squaredNorm();
                          })
      ->point;
}

/// As many lines right across a finger as creases, as far apart as people's are, are these in their
/// order, wherever joints suggest them. False: they aren't, and nothing was named.
bool pair_in_order(const std::vector<Line*>& candidates, const FingerScale& scale,
                   const std::vector<std::size_t>& open) {
  constexpr double kRightAcross = 10.0, kFarthest = 25.0;  // mm
  constexpr double kLeastGap = 8.0, kLargestGap = 45.0;    // mm
  std::vector<Line*> across;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(across),
               [](const Line* line) { return line->breadth >= kRightAcross; });
  if (open.size() < 2 || across.size() != open.size()) return false;
  for (std::size_t k = 0; k < open.size(); ++k) {
    if (std::abs(across[k]->along - scale.place[open[k]]) > kFarthest) return false;
    if (k == 0) continue;
    const double gap = (mean_of(*across[k]) - mean_of(*across[k - 1])).norm();
    if (gap < kLeastGap || gap > kLargestGap) return false;
  }
  for (std::size_t k = 0; k < open.size(); ++k) across[k]->crease = scale.segment[open[k]];
  return true;
}

/// Pairs the lines of a finger with its creases (dynamic programming, where their number doesn't
/// decide).
void pair_lines(std::vector<Line>& lines, const hand::HandCreases& creases, hand::Finger finger) {
  const FingerScale scale(creases, finger);
  std::vector<std::size_t> open;  // creases that no label took
  for (std::size_t k = 0; k < scale.segment.size(); ++k) {
    const bool is_taken = std::any_of(lines.begin(), lines.end(), [&](const Line& line) {
      return !line.labelled_at.empty() && line.crease == scale.segment[k];
    });
    if (!is_taken) open.push_back(k);
  }
  constexpr double kNever = std::numeric_limits<double>::max();
  std::vector<Line*> candidates;
  for (Line& line : lines) {
    if (line.finger == finger && line.labelled_at.empty() && line.breadth >= kLeastBreadth) {
      candidates.push_back(&line);
    }
  }
  if (pair_in_order(candidates, scale, open)) return;
  const std::size_t n = candidates.size(), m = open.size();
  const auto cost = [&](std::size_t i, std::size_t k) {
    const double d = (candidates[i]->along - scale.place[open[k]]) / kSpread;
    return d * d;
  };
  // A broad line far from where proportions suggest a crease is that crease in another hand.
  const auto alone = [&](std::size_t i) {
    return kAlone * std::clamp(candidates[i]->breadth / kLeastBreadth, 1.0, kCertain);
  };
  // best[i][k]: least cost of the first i lines and k creases.
  std::vector<std::vector<double>> best(n + 1, std::vector<double>(m + 1, 0.0));
  for (std::size_t i = 0; i <= n; ++i) {
    for (std::size_t k = 0; k <= m; ++k) {
      if (i == 0 && k == 0) continue;
      const double without_line = i > 0 ? best[i - 1][k] + alone(i - 1) : kNever;
      const double without_crease = k > 0 ? best[i][k - 1] + kAlone : kNever;
      const double paired = i > 0 && k > 0 ? best[i - 1][k - 1] + cost(i - 1, k - 1) : kNever;
      best[i][k] = std::min({without_line, without_crease, paired});
    }
  }
  for (std::size_t i = n, k = m; i > 0 && k > 0;) {
    if (best[i][k] == best[i - 1][k - 1] + cost(i - 1, k - 1)) {
      candidates[i - 1]->crease = scale.segment[open[k - 1]];
      --i;
      --k;
    } else if (best[i][k] == best[i - 1][k] + alone(i - 1)) {
      --i;
    } else {
      --k;
    }
  }
}

/// The plane through a crease's ink; nothing if that is too narrow.
void fit_crease_plane(const std::vector<const Line*>& lines, const Frame& frame,
                      hand::Segment segment, FoundCreases& found) {
  struct Sample {
    double value, aside, weight;
  };
  std::vector<Sample> own;
  double low = 1e9, high = -1e9;
  for (const Line* line : lines) {
    for (const Ink& ink : line->ink) {
      own.push_back({frame.plane.value(ink.point), frame.aside.dot(ink.point - frame.plane.point),
                     ink.weight});
      low = std::min(low, own.back().aside);
      high = std::max(high, own.back().aside);
    }
  }
  if (own.empty() || high - low < kLeastBreadth) {
    found.missing.push_back(segment);
    return;
  }
  double a = 0.0, b = 0.0;  // value = a + b aside
  std::vector<double> use(own.size(), 1.0);
  for (int round = 0; round < 4; ++round) {
    double sw = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t k = 0; k < own.size(); ++k) {
      const double w = own[k].weight * use[k];
      sw += w;
      sx += w * own[k].aside;
      sy += w * own[k].value;
      sxx += w * own[k].aside * own[k].aside;
      sxy += w * own[k].aside * own[k].value;
    }
    const double d = sw * sxx - sx * sx;
    b = d > 1e-9 * sw * sxx ? (sw * sxy - sx * sy) / d : 0.0;
    a = (sy - b * sx) / sw;
    for (std::size_t k = 0; k < own.size(); ++k) {
      const double r = (own[k].value - a - b * own[k].aside) / 1.5;
      use[k] = 1.0 / ((1.0 + r * r) * (1.0 + r * r));
    }
  }
  found.shift[segment] = a;
  found.plane[segment] = {frame.plane.point + a * frame.plane.normal,
                          (frame.plane.normal - b * frame.aside).normalized()};
}

}  // namespace

FoundCreases find_creases(const SkinMarks& marks, const geometry::Rigid3& hand_from_scan,
                          const hand::HandCreases& creases) {
  std::vector<Line> lines = gather(marks, hand_from_scan, creases);
  take_labels(marks, hand_from_scan, lines);
  for (int f = 0; f < hand::kFingerCount; ++f)
    pair_lines(lines, creases, static_cast<hand::Finger>(f));
  FoundCreases found;
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const auto segment = static_cast<hand::Segment>(s);
    std::vector<const Line*> own;
    for (const Line& line : lines) {
      if (line.crease == segment) own.push_back(&line);
    }
    fit_crease_plane(own, frame_of(creases, segment), segment, found);
  }
  const geometry::Rigid3 scan_from_hand = hand_from_scan.inverse();
  const Frame wrist = frame_of(creases, hand::Segment::kPalm);
  const auto of_wrist = std::find_if(lines.begin(), lines.end(), [](const Line& line) {
    return line.crease == hand::Segment::kPalm;
  });
  const double breadth = of_wrist == lines.end() ? 0.0 : of_wrist->breadth;
  for (const Line& line : lines) {
    const bool is_near = !line.finger && !line.crease && !line.is_no_crease && line.breadth > 0.0 &&
                         std::abs(wrist.plane.value(line.ink.front().point)) < kWristReach;
    if (is_near && 2.0 * line.breadth >= breadth) found.other_wrist.push_back(line.along);
    if (!line.crease && !line.is_no_crease) found.stray += static_cast<int>(line.ink.size());
    found.marks.push_back({scan_from_hand * middle_of(line), line.crease});
  }
  return found;
}

}  // namespace palmar::capture
