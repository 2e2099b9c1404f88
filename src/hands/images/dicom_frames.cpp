// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/dicom_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "hands/images/dicom_plane.h"
#include "hands/images/dicom_readout.h"

namespace palmar::images {
namespace {

constexpr double kFarthest = 1e5;  // mm from the first frame
constexpr DicomTag kGridOffsets = 0x3004000C, kSpacingBetweenSlices = 0x00180088;
constexpr DicomTag kFrameIncrement = 0x00280009;

std::map<std::string, std::string> kind_of(const DicomAttributes& attributes) {
  std::map<std::string, std::string> kind;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) kind.emplace(name, value);
  };
  if (const auto echo = attributes.float64(0x00189082)) {  // Effective Echo Time
    add("echo time", fmt::format("{:g} ms", *echo));
  } else if (const auto time = attributes.number(0x00180081)) {  // Echo Time
    add("echo time", fmt::format("{:g} ms", *time));
  }
  if (const auto index = attributes.integer32(0x00209128)) {  // Temporal Position Index
    add("time", fmt::format("{}", *index));
  } else {
    add("time", attributes.text(0x00200100));  // Temporal Position Identifier
  }
  if (const auto b = attributes.float64(0x00189087)) add("b-value", fmt::format("{:g} s/mm2", *b));
  add("stack", attributes.text(0x00209056));             // Stack ID
  const std::string type = attributes.text(0x00089007);  // Frame Type
  add("type", type.empty() ? attributes.text(0x00080008) : type);
  return kind;
}

/// What functional groups say of a slice: of this frame, and of all.
void read_groups(const DicomAttributes& attributes, DicomSlice& slice) {
  slice.thickness = attributes.number(0x00180050);
  if (const std::string side = attributes.text(0x00209072); side == "R" || side == "L") {
    slice.laterality = side;  // Frame Laterality
  }
  if (const std::string type = attributes.text(0x00089007); !type.empty()) slice.image_type = type;
  slice.kind = kind_of(attributes);
  slice.damage = read_rescaling(attributes, slice);
  if (slice.damage.empty()) slice.damage = read_plane(attributes, slice);
  slice.fat_shift = fat_shift_of(attributes, slice);
}

std::vector<DicomSlice> grouped_frames(const DicomElements& elements, const DicomSlice& whole) {
  if (elements.frame.size() != static_cast<std::size_t>(whole.frames)) {
    DicomSlice slice = whole;
    slice.damage = fmt::format(
        "holds {} frames and says of {} where they lie (Per-frame Functional Groups (5200,9230)); "
        "each needs its place",
        whole.frames, elements.frame.size());
    return {slice};
  }
  std::vector<DicomSlice> slices(elements.frame.size(), whole);
  for (std::size_t f = 0; f < slices.size(); ++f) {
    DicomAttributes attributes = elements.frame[f];
    attributes.value.insert(elements.shared.value.begin(), elements.shared.value.end());
    // Of several frames the file's own place would be that of none.
    if (whole.frames == 1) attributes.value.insert(elements.value.begin(), elements.value.end());
    slices[f].frame = static_cast<int>(f);
    read_groups(attributes, slices[f]);
  }
  return slices;
}

/// Distances of the frames from the first, mm along the normal, of a file without functional
/// groups; nothing, and `first.damage`, if it doesn't say them.
std::vector<double> distances_of(const DicomElements& elements, DicomSlice& first) {
  const auto count = static_cast<std::size_t>(first.frames);
  const auto fail = [&](const std::string& why) {
    first.damage = why;
    return std::vector<double>();
  };
  const auto increment = elements.named_tag(kFrameIncrement);
  if (increment == 0x00181063 || increment == 0x00181065) {
    return fail(
        fmt::format("holds {} frames that follow each other in time (Frame Increment Pointer "
                    "(0028,0009)); frames at several places are required",
                    first.frames));
  }
  if (!elements.text(kGridOffsets).empty()) {
    const auto offsets = elements.numbers(kGridOffsets);
    if (!offsets || offsets->size() != count) {
      return fail(fmt::format("Grid Frame Offset Vector (3004,000C) has {} numbers for {} frames",
                              offsets ? offsets->size() : 0, first.frames));
    }
    const double start = offsets->front();
    const bool is_transversal =
        (first.row - Vec3::UnitX()).norm() < 1e-4 && (first.column - Vec3::UnitY()).norm() < 1e-4;
    if (start != 0.0 &&
        !(is_transversal && std::abs(start - first.position.z()) <= kSamePosition)) {
      return fail(
          fmt::format("Grid Frame Offset Vector (3004,000C) begins with {:g} mm; 0 is required, or "
                      "z of Image Position (0020,0032) if slices are transversal",
                      start));
    }
    std::vector<double> distances;
    for (const double offset : *offsets) {
      if (!(std::abs(offset - start) <= kFarthest)) {
        return fail(fmt::format(
            "Grid Frame Offset Vector (3004,000C) holds {:g} mm; up to {:g} mm are allowed", offset,
            kFarthest));
      }
      distances.push_back(offset - start);
    }
    return distances;
  }
  if (elements.text(kSpacingBetweenSlices).empty()) {
    return fail(
        fmt::format("holds {} frames and doesn't say where each lies: it has no Per-frame "
                    "Functional Groups (5200,9230), Grid Frame Offset Vector (3004,000C) or "
                    "Spacing Between Slices (0018,0088)",
                    first.frames));
  }
  const auto spacing = elements.number(kSpacingBetweenSlices);
  if (!spacing || !(*spacing >= 0.01 && *spacing <= 100.0)) {
    return fail(
        fmt::format("Spacing Between Slices (0018,0088) is \"{}\" mm; 0.01 to 100 mm are allowed",
                    elements.text(kSpacingBetweenSlices)));
  }
  first.has_assumed_order = true;
  std::vector<double> distances;
  for (std::size_t f = 0; f < count; ++f) distances.push_back(static_cast<double>(f) * *spacing);
  return distances;
}

/// Frames without functional groups: the file's own position is that of the first.
std::vector<DicomSlice> stacked_frames(const DicomElements& elements, const DicomSlice& whole) {
  DicomSlice first = whole;
  first.kind = kind_of(elements);
  first.damage = read_plane(elements, first);
  first.fat_shift = fat_shift_of(elements, first);
  if (!first.damage.empty() || first.frames == 1) return {first};
  const std::vector<double> distances = distances_of(elements, first);
  if (!first.damage.empty()) return {first};
  std::vector<DicomSlice> slices(distances.size(), first);
  const Vec3 normal = first.row.cross(first.column);
  for (std::size_t f = 0; f < slices.size(); ++f) {
    slices[f].frame = static_cast<int>(f);
    slices[f].position += distances[f] * normal;
  }
  return slices;
}

}  // namespace

std::vector<DicomSlice> frames_of(const DicomElements& elements, const DicomSlice& whole) {
  const bool has_groups = !elements.frame.empty() || !elements.shared.value.empty();
  return has_groups ? grouped_frames(elements, whole) : stacked_frames(elements, whole);
}

}  // namespace palmar::images
