// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/dicom_readout.h"

#include <algorithm>

namespace palmar::images {
namespace {

/// Samples along the read-out: the first of Acquisition Matrix' numbers (of the read-out along rows
/// or columns; the other one is 0), 16 bits each. 0 if it isn't there.
int readout_samples(const DicomAttributes& attributes) {
  const auto found = attributes.value.find(0x00181310);
  if (found == attributes.value.end() || found->second.size() < 4) return 0;
  const auto at = [&](std::size_t k) {
    return static_cast<unsigned char>(found->second[2 * k]) +
           256 * static_cast<unsigned char>(found->second[2 * k + 1]);
  };
  return std::max(at(0), at(1));
}

}  // namespace

Vec3 fat_shift_of(const DicomAttributes& attributes, const DicomSlice& slice) {
  std::optional<double> frequency = attributes.number(0x00180084);  // MHz
  if (!frequency) frequency = attributes.float64(0x00189098);
  const std::optional<double> bandwidth = attributes.number(0x00180095);  // Hz
  const std::string phase = attributes.text(0x00181312);
  const bool is_across = phase == "ROW", is_along = phase == "COL" || phase == "COLUMN";
  if (!frequency || !bandwidth || !(is_across || is_along)) return Vec3::Zero();
  if (!(*frequency > 1.0 && *frequency < 1000.0 && *bandwidth > 1.0 && *bandwidth < 1e5)) {
    return Vec3::Zero();
  }
  const int pixels = is_along ? slice.columns : slice.rows;
  const double size = is_along ? slice.pixel_width : slice.pixel_height;
  const int samples = readout_samples(attributes);
  const bool is_plausible = samples >= pixels / 8 && samples <= 4 * pixels && samples > 0;
  const double acquired = is_plausible ? size * pixels / samples : size;
  return kFatBelowWater * 1e6 * *frequency / *bandwidth * acquired *
         (is_along ? slice.row : slice.column);
}

}  // namespace palmar::images
