// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/sensors/sensor_layout.h"

#include <fmt/format.h>

#include <set>

#include "palmar/core/error.h"

namespace palmar::study {
namespace {

SensorLayout mat_layout() {
  SensorLayout layout;
  layout.name = "mat";
  layout.kind = SensorKind::kMat;
  layout.pitch = 5.0;
  layout.source = "4 cells per cm2: Kutz et al. 2009; number of rows: our choice";
  layout.rows = 32;
  return layout;
}

SensorLayout glove_layout() {
  SensorLayout layout;
  layout.name = "glove";
  layout.kind = SensorKind::kGlove;
  layout.pitch = 5.0;
  layout.source = "our choice";
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const std::optional<hand::Region> region = hand::region_of(static_cast<hand::Segment>(s));
    if (region) layout.patches.push_back({*region, 4, 3});
  }
  layout.patches.push_back({hand::Region::kThenar, 8, 6});
  layout.patches.push_back({hand::Region::kHypothenar, 10, 6});
  layout.patches.push_back({hand::Region::kCentralPalm, 6, 5});
  layout.patches.push_back({hand::Region::kRadialPalm, 4, 8});
  layout.patches.push_back({hand::Region::kUlnarPalm, 4, 8});
  return layout;
}

void require_count(const std::string& where, const char* what, int count, int fewest) {
  if (count >= fewest && count <= kMostSensorRows) return;
  throw UsageError(fmt::format("{}: {} is {}; {} to {} are allowed", where, what, count, fewest,
                               kMostSensorRows));
}

void require_direction(const std::string& where, const char* what,
                       const std::optional<Vec3>& direction) {
  if (!direction || (direction->allFinite() && direction->norm() > 1e-9)) return;
  throw UsageError(where + ": " + what + " has no direction; a vector other than 0 is required");
}

void check_free(const std::string& where, const std::vector<FreeSensor>& sensors) {
  if (sensors.empty()) throw UsageError(where + ": no sensor is given; one is required");
  std::set<std::string> names;
  for (const FreeSensor& one : sensors) {
    const std::string which = where + ", sensor \"" + one.name + "\"";
    if (!names.insert(one.name).second) throw UsageError(which + ": its name stands twice");
    if (!one.at.allFinite()) throw UsageError(which + ": its place is not finite");
    if (!(one.area > 0.0 && one.area <= kMostSensorArea)) {
      throw UsageError(fmt::format("{}: its area is {} mm2; more than 0 and at most {} are allowed",
                                   which, one.area, kMostSensorArea));
    }
  }
}

}  // namespace

std::string_view name_of(SensorKind kind) {
  if (kind == SensorKind::kMat) return "mat";
  return kind == SensorKind::kGlove ? "glove" : "free";
}

void SensorLayout::check() const {
  const std::string where = "sensor layout \"" + name + "\"";
  if (kind == SensorKind::kFree) {
    check_free(where, sensors);
    return;
  }
  if (!(pitch >= kFinestPitch && pitch <= kCoarsestPitch)) {
    throw UsageError(fmt::format("{}: pitch is {} mm; {} to {} mm are allowed", where, pitch,
                                 kFinestPitch, kCoarsestPitch));
  }
  if (kind == SensorKind::kMat) {
    require_count(where, "rows", rows, 1);
    require_count(where, "columns", columns, 0);
    require_direction(where, "axis", axis);
    require_direction(where, "seam", seam);
    if (axis && seam && axis->cross(*seam).norm() < 1e-6 * axis->norm() * seam->norm()) {
      throw UsageError(where + ": the seam lies along the axis; a direction across it is required");
    }
    return;
  }
  if (patches.empty()) throw UsageError(where + ": a glove without patches; one is required");
  std::set<hand::Region> taken;
  for (const SensorPatch& patch : patches) {
    const std::string region(name_of(patch.region));
    if (patch.region == hand::Region::kDorsum) {
      throw UsageError(where + ": a patch on the dorsum; palmar regions are allowed");
    }
    if (!taken.insert(patch.region).second) {
      throw UsageError(where + ": two patches on " + region + "; one is allowed");
    }
    require_count(where + ", patch on " + region, "rows", patch.rows, 1);
    require_count(where + ", patch on " + region, "columns", patch.columns, 1);
  }
}

const std::vector<SensorLayout>& sensor_layouts() {
  static const std::vector<SensorLayout> layouts = {mat_layout(), glove_layout()};
  return layouts;
}

std::optional<SensorLayout> sensor_layout_named(std::string_view name) {
  for (const SensorLayout& layout : sensor_layouts()) {
    if (layout.name == name) return layout;
  }
  return std::nullopt;
}

}  // namespace palmar::study
