// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/contact/skin_touch.h"
#include "palmar/hand/hand.h"

namespace palmar::contact {

/// Which skin of a hand meets which when fingers bend: phalanges side by side, on the palm, on each
/// other, the thumb on fingers.
///
/// Skin of one segment never meets itself. Nor does the skin that a joint folds (its blending
/// weight lies between 0 and 1, Xie 2014, eq. 2-7) meet skin beside that joint: in a crease skin
/// goes where the skinning puts it, and what presses there is the bending of tissue, no contact.
/// Rigid skin of two neighbouring segments may meet. (Our choice; no source.)
///
/// Of two segments the one further from the palm brings the vertices and the other the triangles;
/// of equals, that of the finger nearer to the thumb. So every touch is told once, and force equals
/// reaction by construction.
class SkinMeetings {
 public:
  explicit SkinMeetings(const hand::Hand& hand);

  /// Meetings in a posture, with the outward normals of the posed skin: at most one per vertex, the
  /// nearest, up to `range` [mm] apart and kDeepestCrossing deep; ascending by vertex. Any frame.
  std::vector<SkinMeeting> find(const std::vector<Vec3>& posed, const std::vector<Vec3>& normal,
                                double range) const;

 private:
  /// Vertices of one segment that lie together.
  struct Cluster {
    int segment = 0;
    std::vector<int> vertex;
    unsigned all_fold = 0, all_beside = 0;  ///< bits that all of them have
  };
  bool may_meet(int v, int w) const;
  void walk_to(const std::vector<Vec3>& posed, const Vec3& target, int from,
               SkinMeeting& meeting) const;
  SkinMeeting meeting(const std::vector<Vec3>& posed, const std::vector<Vec3>& normal, int v,
                      int nearest) const;

  const hand::Hand* hand_;
  std::vector<Cluster> cluster_;                      ///< ordered by segment
  std::array<int, hand::kSegmentCount + 1> first_{};  ///< of each segment in cluster_
  std::vector<int> triangle_begin_, triangle_;        ///< per vertex: the triangles round it
  /// Per vertex, as bits: joints that fold it, and joints that its segment or a fold lies beside.
  std::vector<unsigned> fold_, beside_;
};

/// Skin that has crossed other skin deeper than this [mm] isn't seen as such: half a finger's
/// thickness, beyond which the way out leads to the other side.
inline constexpr double kDeepestCrossing = 6.0;

/// Deepest crossing among meetings, mm; 0 if none crosses.
double deepest_crossing(const std::vector<SkinMeeting>& meetings);

}  // namespace palmar::contact
