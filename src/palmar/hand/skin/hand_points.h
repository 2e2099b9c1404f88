// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// A point that goes with a hand's posture: glued to its skin, or to one of its rigid parts.
struct HandPoint {
  Vec3 reference = Vec3::Zero();  ///< hand frame, reference posture, mm
  /// The skin vertex that it moves with (the same joint weights), or nothing: the part.
  std::optional<int> vertex;
  std::vector<JointId> joints;  ///< of a rigid part: the joints that carry it wholly
};

/// A point `height` [mm] above a skin vertex along the skin's normal. Throws UsageError for a
/// vertex that isn't there.
HandPoint skin_point(const Hand& hand, int vertex, double height = 0.0);

/// A point that goes with the skin nearest to it in the reference posture.
HandPoint skin_point_near(const Hand& hand, const Vec3& reference);

/// A point of a rigid part: a segment ("palm", "index_distal", ...), "thumb_metacarpal" or
/// "forearm". Throws UsageError for another name, with the nearest one.
HandPoint part_point(const std::string& part, const Vec3& reference);
std::vector<std::string> part_names();

/// Points of one hand that are posed again and again.
class PosablePoints {
 public:
  PosablePoints(const Hand& hand, const std::vector<HandPoint>& points);

  int count() const { return static_cast<int>(few_.skin.vertices.size()); }
  const Skeleton& skeleton() const { return few_.skeleton; }

  /// Positions in the hand frame, mm: those of pose_skin() for points on skin vertices, those of
  /// pose_skeleton() for points of rigid parts.
  std::vector<Vec3> pose(const Posture& posture) const;

 private:
  Hand few_;  ///< whose skin is the points alone
};

}  // namespace palmar::hand
