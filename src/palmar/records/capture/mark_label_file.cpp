// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/capture/mark_label_file.h"

#include <fmt/format.h>

#include <array>

#include "palmar/core/nearest_name.h"
#include "palmar/formats/csv_reader.h"

namespace palmar {
namespace {

using Kind = MarkLabel::Kind;

constexpr const char* kWrist = "wrist";
constexpr const char* kNone = "none";

/// Names that a mark may have.
std::vector<std::string> names_of(Kind kind) {
  std::vector<std::string> names{
      kind == Kind::kCrease ? kWrist : std::string(name_of(Segment::kPalm)), kNone};
  for (int k = 1; k < kSegmentCount; ++k) names.emplace_back(name_of(static_cast<Segment>(k)));
  return names;
}

/// The segment of a name; nothing: no mark. `is_known` is false for what names nothing.
std::optional<Segment> segment_of(const std::string& name, Kind kind, bool& is_known) {
  is_known = true;
  if (name == kNone) return {};
  if (kind == Kind::kCrease && name == kWrist) return Segment::kPalm;
  const auto segment = segment_named(name);
  is_known = segment && (kind == Kind::kDot || *segment != Segment::kPalm);
  return segment;
}

std::string kind_name(Kind kind) { return kind == Kind::kCrease ? "crease" : "dot"; }

}  // namespace

std::string mark_name(MarkLabel::Kind kind, const std::optional<Segment>& segment) {
  if (!segment) return {};
  return kind == Kind::kCrease && *segment == Segment::kPalm ? kWrist
                                                             : std::string(name_of(*segment));
}

MarkText mark_text_of(const MarkLabel& label) {
  return {.posture = std::string(name_of(label.posture)),
          .mark = (label.is_added ? "added_" : "") + kind_name(label.kind),
          .name = label.segment ? mark_name(label.kind, label.segment) : kNone,
          .point = label.point,
          .place = label.place};
}

std::optional<MarkLabel> mark_label_of(const MarkText& text,
                                       const std::function<void(const std::string&)>& fail) {
  MarkLabel label;
  label.place = text.place;
  const auto known = scan_posture_in(text.posture);
  if (!known) {
    fail("\"" + text.posture +
         "\" is no posture; reference, finger_flexion, finger_abduction ... are allowed");
  }
  label.posture = known.value_or(ScanPosture::kReference);
  label.is_added = text.mark == "added_crease" || text.mark == "added_dot";
  if (!label.is_added && text.mark != "crease" && text.mark != "dot") {
    fail("mark \"" + text.mark + "\"; crease, dot, added_crease or added_dot is allowed");
  }
  label.kind = text.mark == "crease" || text.mark == "added_crease" ? Kind::kCrease : Kind::kDot;
  label.point = text.point;
  if (text.name.empty() && !label.is_added) return {};
  bool is_known = true;
  label.segment = segment_of(text.name, label.kind, is_known);
  if (!is_known) {
    fail(fmt::format("\"{}\" names no {}; the nearest name is \"{}\"", text.name,
                     label.kind == Kind::kCrease ? "crease" : "segment with dots",
                     nearest_name(text.name, names_of(label.kind))));
  }
  if (label.is_added && !label.segment) {
    fail("a mark that is added must have a name; \"none\" takes away what was found");
  }
  return label;
}

std::vector<MarkLabel> read_mark_labels(const std::string& path) {
  const CsvFile file = read_csv(path);
  const std::array<const char*, 6> names = {"posture", "mark", "name", "x_mm", "y_mm", "z_mm"};
  std::array<std::size_t, 6> column{};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const int found = file.column(names[k]);
    if (found < 0) {
      file.fail(file.header_line, std::string("has no column ") + names[k] +
                                      "; posture, mark, name, x_mm, y_mm and z_mm are needed");
    }
    column[k] = static_cast<std::size_t>(found);
  }
  std::vector<MarkLabel> labels;
  for (const CsvFile::Row& row : file.rows) {
    MarkText text{row.cells[column[0]], row.cells[column[1]], row.cells[column[2]], Vec3::Zero(),
                  path + ":" + std::to_string(row.line)};
    for (int a = 0; a < 3; ++a) {
      text.point[a] = file.number(row, column[static_cast<std::size_t>(a) + 3]);
    }
    const auto label =
        mark_label_of(text, [&](const std::string& why) { file.fail(row.line, why); });
    if (label) labels.push_back(*label);
  }
  return labels;
}

CsvTable mark_table(const std::vector<TakenMark>& marks) {
  CsvTable table{{"posture", "mark", "name", "x_mm", "y_mm", "z_mm"}, {}};
  for (const TakenMark& mark : marks) {
    table.rows.push_back({std::string(name_of(mark.posture)), kind_name(mark.kind),
                          mark_name(mark.kind, mark.segment), fmt::format("{:.2f}", mark.point.x()),
                          fmt::format("{:.2f}", mark.point.y()),
                          fmt::format("{:.2f}", mark.point.z())});
  }
  return table;
}

}  // namespace palmar
