// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/hand/anatomy.h"

namespace palmar::study {

/// What carries a sensor's cells.
enum class SensorKind {
  kMat,    ///< a sheet wrapped round the held part: cells in rows along its axis
  kGlove,  ///< patches on the palmar skin: cells move with the hand
  kFree    ///< single sensors stuck to the product
};
std::string_view name_of(SensorKind kind);  ///< "mat", "glove", "free"

/// Cells on the skin of one region, about its middle.
struct SensorPatch {
  hand::Region region{};
  int rows = 0;     ///< along the finger or the hand; row 1 is the nearest to the wrist
  int columns = 0;  ///< across; column 1 is on the little finger's side
};

/// A round sensor by itself on the product.
struct FreeSensor {
  std::string name;
  Vec3 at = Vec3::Zero();  ///< its middle, product frame, mm
  double area = 0.0;       ///< mm^2
};

/// A pressure sensor: cells and where they lie. A value; the built-in ones are
/// sensor_layouts().
struct SensorLayout {
  std::string name;
  SensorKind kind = SensorKind::kMat;
  double pitch = 0.0;  ///< of a mat or glove: from cell to cell, both ways, mm
  std::string source;  ///< of pitch and numbers

  // A mat. Rows run along the axis, columns round it, against the clock seen from the axis' tip.
  int rows = 0;
  int columns = 0;  ///< 0: as many as the girth has room for
  /// Product frame, mm: the middle of the rows is beside it. Unset: where the hand is.
  std::optional<Vec3> origin;
  /// Unit, product frame. Unset: the grip axis, towards the thumb's side.
  std::optional<Vec3> axis;
  /// From the axis to where column 1 begins. Unset: the product's x (its y where that is the axis).
  std::optional<Vec3> seam;

  std::vector<SensorPatch> patches;  ///< of a glove
  std::vector<FreeSensor> sensors;   ///< free ones

  void check() const;  ///< throws UsageError: layout, what is wrong, what is allowed
};

// Limits of a layout.
inline constexpr double kFinestPitch = 1.0, kCoarsestPitch = 50.0;  // mm
inline constexpr int kMostSensorRows = 200;                         // or columns
inline constexpr double kMostSensorArea = 2500.0;                   // mm^2, of a free one

/// Those that are built in:
///
/// `mat`: cells of 5 mm, 4 per cm^2, as the array that Kutz et al. 2009 (Sensors 9:6330) stuck to a
/// rod of 20 mm for measuring fingers' grip; 32 rows (160 mm, more than a hand is wide: our choice)
/// and as many columns as go round.
///
/// `glove`: patches of 5 mm cells on all 14 phalanges and five parts of the palm. Pitch and numbers
/// are our choice; measured gloves differ, and a file says how.
const std::vector<SensorLayout>& sensor_layouts();

/// A built-in layout; nothing for another name.
std::optional<SensorLayout> sensor_layout_named(std::string_view name);

}  // namespace palmar::study
