// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/mark_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "palmar/core/error.h"

namespace palmar::capture {
namespace {

constexpr double kReach = 3.0;  // mm

std::string place_text(const Vec3& p) {
  return fmt::format("{:.1f}, {:.1f}, {:.1f}", p.x(), p.y(), p.z());
}

[[noreturn]] void fail_none_there(const hand::MarkLabel& label, double nearest) {
  const char* what = label.kind == hand::MarkLabel::Kind::kDot ? "dot" : "line";
  const std::string far = nearest < std::numeric_limits<double>::max()
                              ? fmt::format("the nearest is {:.1f} mm away", nearest)
                              : "none was found at all";
  throw InputError(
      fmt::format("{}: no {} within {:.0f} mm of {} in the {} scan; {} (added_{} adds one)",
                  label.place, what, kReach, place_text(label.point), name_of(label.posture), far,
                  label.kind == hand::MarkLabel::Kind::kDot ? "dot" : "crease"));
}

/// Names dots of one scan; those named to be none are dropped at the end.
class DotLabels {
 public:
  explicit DotLabels(SkinMarks& marks)
      : marks_(marks), by_(marks.dots.size()), is_none_(by_.size()) {}

  void take(const hand::MarkLabel& label) {
    if (label.is_added) {
      marks_.dots.push_back({label.point, 0.0, label.segment});
      return;
    }
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < by_.size(); ++k) {
      const double d = (marks_.dots[k].point - label.point).norm();
      if (d >= least) continue;
      least = d;
      nearest = k;
    }
    if (least > kReach) fail_none_there(label, least);
    if (!by_[nearest].empty()) {
      throw InputError(fmt::format("{}: the dot at {} was named in {} already", label.place,
                                   place_text(marks_.dots[nearest].point), by_[nearest]));
    }
    by_[nearest] = label.place;
    marks_.dots[nearest].segment = label.segment;
    is_none_[nearest] = label.segment ? 0 : 1;
  }

  void drop() {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < marks_.dots.size(); ++k) {
      if (k < is_none_.size() && is_none_[k]) continue;
      marks_.dots[kept++] = marks_.dots[k];
    }
    marks_.dots.resize(kept);
  }

 private:
  SkinMarks& marks_;
  std::vector<std::string> by_;  // of the dots that were found: place of the label
  std::vector<char> is_none_;
};

void take_crease(const hand::MarkLabel& label, SkinMarks& marks) {
  double least = std::numeric_limits<double>::max();
  for (const InkLine& line : marks.lines) {
    for (const Vec3& p : line.point) least = std::min(least, (p - label.point).norm());
  }
  if (least > kReach) fail_none_there(label, least);
  marks.crease_labels.push_back({label.point, label.segment, label.place});
}

/// Points of one crease that were added make one line.
void add_creases(const std::vector<const hand::MarkLabel*>& added, SkinMarks& marks) {
  std::map<hand::Segment, InkLine> lines;
  std::map<hand::Segment, std::string> place;
  for (const hand::MarkLabel* label : added) {
    InkLine& line = lines[*label->segment];
    line.crease = label->segment;
    line.point.push_back(label->point);
    line.weight.push_back(1.0);
    place.try_emplace(*label->segment, label->place);
  }
  for (auto& [segment, line] : lines) {
    double breadth = 0.0;
    for (const Vec3& p : line.point) breadth = std::max(breadth, (p - line.point.front()).norm());
    constexpr double kLeast = 5.0;  // mm
    if (breadth < kLeast) {
      throw InputError(fmt::format(
          "{}: what is added of the crease of {} reaches over {:.1f} mm; points {:.0f} mm or more "
          "apart are needed",
          place[segment], segment == hand::Segment::kPalm ? "wrist" : name_of(segment), breadth,
          kLeast));
    }
    marks.added_lines.push_back(std::move(line));
  }
}

}  // namespace

void apply_mark_labels(const std::vector<hand::MarkLabel>& labels,
                       std::map<hand::ScanPosture, SkinMarks*>& marks) {
  std::map<hand::ScanPosture, DotLabels> dots;
  std::vector<const hand::MarkLabel*> added;
  for (const hand::MarkLabel& label : labels) {
    const auto scan = marks.find(label.posture);
    if (scan == marks.end()) {
      throw InputError(
          fmt::format("{}: no scan shows the posture {}", label.place, name_of(label.posture)));
    }
    if (label.kind == hand::MarkLabel::Kind::kDot) {
      dots.try_emplace(label.posture, *scan->second).first->second.take(label);
      continue;
    }
    if (label.posture != hand::ScanPosture::kReference) {
      throw InputError(fmt::format("{}: creases are taken from the reference scan, not from {}",
                                   label.place, name_of(label.posture)));
    }
    if (label.is_added) {
      added.push_back(&label);
    } else {
      take_crease(label, *scan->second);
    }
  }
  for (auto& [posture, of_scan] : dots) of_scan.drop();
  if (!added.empty()) add_creases(added, *marks.at(hand::ScanPosture::kReference));
}

}  // namespace palmar::capture
