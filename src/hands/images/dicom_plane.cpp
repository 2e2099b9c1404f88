// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/dicom_plane.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace palmar::images {
namespace {

constexpr double kSquare = 1e-3;  // cosine between axes that still counts as square

/// "has no NAME", with what stands there instead if that is short.
std::string lacks(const DicomAttributes& attributes, DicomTag tag, const char* name) {
  const std::string text = attributes.text(tag);
  const bool is_shown = !text.empty() && text.size() <= 80;
  return fmt::format("has no {}{}", name, is_shown ? "; it says \"" + text + "\"" : "");
}

}  // namespace

std::string read_plane(const DicomAttributes& attributes, DicomSlice& slice) {
  const auto orientation = attributes.numbers(0x00200037);
  if (!orientation || orientation->size() != 6) {
    return lacks(attributes, 0x00200037, "Image Orientation (0020,0037) of six numbers");
  }
  const auto position = attributes.numbers(0x00200032);
  if (!position || position->size() != 3) {
    return lacks(attributes, 0x00200032, "Image Position (0020,0032) of three numbers");
  }
  const auto spacing = attributes.numbers(0x00280030);
  if (!spacing || spacing->size() != 2) {
    return lacks(attributes, 0x00280030, "Pixel Spacing (0028,0030) of two numbers");
  }
  const std::vector<double>& o = *orientation;
  slice.row = Vec3(o[0], o[1], o[2]);
  slice.column = Vec3(o[3], o[4], o[5]);
  slice.position = Vec3((*position)[0], (*position)[1], (*position)[2]);
  slice.pixel_height = (*spacing)[0];
  slice.pixel_width = (*spacing)[1];
  for (const Vec3* axis : {&slice.row, &slice.column}) {
    if (std::abs(axis->norm() - 1.0) > 0.01) {
      return fmt::format("Image Orientation (0020,0037): an axis has length {:g}; 1 is required",
                         axis->norm());
    }
  }
  const double cosine = slice.row.dot(slice.column);
  if (std::abs(cosine) > kSquare) {
    return fmt::format(
        "Image Orientation (0020,0037): the axes aren't square; the angle between them is {:.2f} "
        "degrees",
        std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::acos(-1.0));
  }
  // Six digits, as most scanners write, tilt axes by about 1e-6.
  slice.row.normalize();
  slice.column = (slice.column - slice.row.dot(slice.column) * slice.row).normalized();
  for (const double size : {slice.pixel_width, slice.pixel_height}) {
    if (!(size >= 0.01 && size <= 100.0)) {
      return fmt::format("Pixel Spacing (0028,0030) is {:g} mm; 0.01 to 100 mm are allowed", size);
    }
  }
  if (slice.position.cwiseAbs().maxCoeff() > 1e5) {
    return fmt::format(
        "Image Position (0020,0032) is {:g} mm away from the origin; up to 100000 mm along each "
        "axis "
        "are allowed",
        slice.position.norm());
  }
  return {};
}

std::string read_rescaling(const DicomAttributes& attributes, DicomSlice& slice) {
  for (const auto& [tag, target, name] :
       {std::tuple{DicomTag{0x00281053}, &slice.slope, "Rescale Slope (0028,1053)"},
        std::tuple{DicomTag{0x00281052}, &slice.intercept, "Rescale Intercept (0028,1052)"}}) {
    if (attributes.text(tag).empty()) continue;
    const auto value = attributes.number(tag);
    if (!value || std::abs(*value) > 1e12) {
      return fmt::format("{} is \"{}\"; a number is required", name, attributes.text(tag));
    }
    *target = *value;
  }
  if (slice.slope == 0.0) return "Rescale Slope (0028,1053) is 0; another number is required";
  return {};
}

}  // namespace palmar::images
