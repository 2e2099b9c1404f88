// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palmar::images {

/// What a camera writes into its photographs about itself. Zero or empty: it doesn't say.
struct PhotoExif {
  std::string camera;          ///< maker, model and serial number of the body
  double focal_mm = 0.0;       ///< focal length as the lens says, mm
  double focal_35mm = 0.0;     ///< that which shows as much on film of 36 x 24 mm, mm
  double pixels_per_mm = 0.0;  ///< of the sensor, for a picture `width` pixels wide
  int width = 0, height = 0;   ///< pixels, as they left the camera

  /// Focal length in pixels of a picture of this size; nothing if the camera doesn't say enough.
  /// Good to a few percent: lenses say round numbers, and focusing near by changes them.
  std::optional<double> focal_pixels(int picture_width, int picture_height) const;

  /// Whether a picture of this size has other proportions than what left the camera, by more than
  /// rounding to pixels does: then the lens' axis isn't in its middle any more.
  bool is_cropped(int picture_width, int picture_height) const;
};

/// The data of a JPEG file, of which the first 64 KB suffice; nothing if there are none. Damaged
/// ones count as none: pictures are good without.
/// Source: CIPA DC-008, Exif 2.32, sections 4.5 and 4.6.
std::optional<PhotoExif> read_exif(std::string_view jpeg);

/// The data as a JPEG file holds them (its segment APP1, without the marker and the length).
std::string format_exif(const PhotoExif& exif);

}  // namespace palmar::images
