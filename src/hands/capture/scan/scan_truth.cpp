// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/scan_truth.h"

#include <algorithm>
#include <cmath>

#include "palmar/geometry/distance/closest_point.h"
#include "palmar/hand/dimensions/hand_dimension.h"

namespace palmar::capture {
namespace {

DimensionErrors over_segments(const hand::HandDimensions& difference,
                              double hand::SegmentDimensions::*dimension) {
  DimensionErrors errors;
  for (const hand::SegmentDimensions& segment : difference.segment) {
    const double d = std::abs(segment.*dimension);
    errors.mean += d / hand::kSegmentCount;
    errors.largest = std::max(errors.largest, d);
  }
  return errors;
}

void measure_skin(const HandFromScan& made, const geometry::TriangleMesh& skin,
                  ScanErrors& errors) {
  if (skin.triangles.empty()) return;
  const geometry::ClosestPointQuery query(skin);
  std::vector<double> distance;
  for (const Vec3& v : made.scanned.hand.skin.vertices) {
    if (v.y() < 0.0) continue;
    const auto near = query.closest(made.scanned.patient_from_hand * v);
    if (near) distance.push_back(near->distance);
  }
  if (distance.empty()) return;
  for (const double d : distance) errors.skin_mean += d / static_cast<double>(distance.size());
  const auto p95 = distance.begin() + static_cast<std::ptrdiff_t>(distance.size() * 95 / 100);
  std::nth_element(distance.begin(), p95, distance.end());
  errors.skin_p95 = *p95;
}

}  // namespace

ScanErrors scan_errors(const HandFromScan& made, const ScanTruth& truth) {
  ScanErrors errors;
  const hand::HandDimensions& found = made.scanned.hand.dimensions;
  for (const hand::HandDimension& d : hand::all_hand_dimensions()) {
    hand::set_value(errors.difference, d,
                    hand::value_of(found, d) - hand::value_of(truth.dimensions, d));
  }
  // The palm's breadth and thickness are those of the hand.
  errors.difference.segment[0].width = errors.difference.hand_width;
  errors.difference.segment[0].thickness = errors.difference.hand_thickness;
  errors.x = over_segments(errors.difference, &hand::SegmentDimensions::width);
  errors.y = over_segments(errors.difference, &hand::SegmentDimensions::length);
  errors.z = over_segments(errors.difference, &hand::SegmentDimensions::thickness);
  for (const auto& [posture, real] : truth.postures) {
    if (!made.scan_from_hand.contains(posture) || !made.postures.contains(posture)) continue;
    const PlacedJoints own = joints_in_scan(made, posture);
    for (const auto& [segment, joint] : real.joint) {
      const auto& mine = own.joint.at(segment);
      const double cosine = std::min(1.0, std::abs(joint.axis.dot(mine.axis)));
      errors.places.push_back(
          {posture, segment, (joint.centre - mine.centre).norm(), std::acos(cosine)});
    }
    for (const auto& [segment, tip] : real.fingertip) {
      errors.places.push_back({posture, segment, (tip - own.fingertip.at(segment)).norm(), {}});
    }
  }
  measure_skin(made, truth.skin, errors);
  return errors;
}

std::optional<MeanPlaceError> mean_error(const ScanErrors& errors, hand::ScanPosture posture,
                                         FingerPlace place) {
  MeanPlaceError mean;
  int count = 0;
  for (const PlaceError& error : errors.places) {
    const auto finger = hand::finger_of(error.segment);
    if (error.posture != posture || !finger || *finger == hand::Finger::kThumb) continue;
    const auto chain = hand::segments_of(*finger);
    const bool is_tip = !error.axis;
    const bool is_asked =
        place == FingerPlace::kTip
            ? is_tip
            : !is_tip && error.segment == *chain[place == FingerPlace::kPip ? 1 : 2];
    if (!is_asked) continue;
    ++count;
    mean.place += error.place;
    if (error.axis) mean.axis = mean.axis.value_or(0.0) + *error.axis;
  }
  if (count == 0) return {};
  mean.place /= count;
  if (mean.axis) *mean.axis /= count;
  return mean;
}

}  // namespace palmar::capture
