// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/posture/marker_set.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/skin/landmarks.h"
#include "palmar/hand/skin/skinning.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

using ::testing::HasSubstr;

class LandmarksTest : public TemplateTest {
 protected:
  static std::string message_of(const std::function<void()>& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(LandmarksTest, EveryNameHasAPointNearTheHand) {
  const hand::Landmarks landmarks(hand());
  const std::vector<std::string> names = hand::Landmarks::names();
  EXPECT_GT(names.size(), 80U);
  for (const std::string& name : names) {
    const hand::HandPoint point = landmarks.at(name);
    double nearest = 1e9;
    for (const Vec3& v : hand().skin.vertices) {
      nearest = std::min(nearest, (v - point.reference).norm());
    }
    // On the skin: within an edge of a vertex. Joint centres: inside, half a thickness.
    EXPECT_LT(nearest, name.ends_with("centre") ? 20.0 : 2.5) << name;
  }
}

TEST_F(LandmarksTest, SidesLieWhereTheirNamesSay) {
  const hand::Landmarks landmarks(hand());
  for (const std::string joint : {"index_pip", "middle_dip", "ring_pip", "little_dip"}) {
    const Vec3 centre = landmarks.at(joint + "_centre").reference;
    // Right hand, about straight fingers: x radial, z palmar; half a finger's thickness is 4 to 12
    // mm.
    EXPECT_LT(landmarks.at(joint + "_dorsal").reference.z(), centre.z() - 4) << joint;
    EXPECT_GT(landmarks.at(joint + "_palmar").reference.z(), centre.z() + 4) << joint;
    EXPECT_GT(landmarks.at(joint + "_radial").reference.x(), centre.x() + 4) << joint;
    EXPECT_LT(landmarks.at(joint + "_ulnar").reference.x(), centre.x() - 4) << joint;
    for (const std::string side : {"_dorsal", "_palmar", "_radial", "_ulnar"}) {
      EXPECT_LT((landmarks.at(joint + side).reference - centre).norm(), 12) << joint << side;
    }
  }
  // Metacarpals: head, middle and base follow each other towards the wrist.
  for (const std::string bone : {"first", "second", "third", "fourth", "fifth"}) {
    const double head = landmarks.at(bone + "_metacarpal_head").reference.y();
    const double middle = landmarks.at(bone + "_metacarpal_middle").reference.y();
    const double base = landmarks.at(bone + "_metacarpal_base").reference.y();
    EXPECT_GT(head, middle + 10) << bone;
    EXPECT_GT(middle, base + 10) << bone;
  }
}

TEST_F(LandmarksTest, AMirroredHandHasMirroredLandmarks) {
  const hand::Hand left = hand::mirrored(hand());
  const hand::Landmarks here(hand()), there(left);
  for (const std::string& name : hand::Landmarks::names()) {
    Vec3 expected = here.at(name).reference;
    expected.x() = -expected.x();
    // Rays are traced in single precision.
    EXPECT_LT((there.at(name).reference - expected).norm(), 1e-3) << name;
  }
}

TEST_F(LandmarksTest, HeightLiftsOffTheSkin) {
  const hand::Landmarks landmarks(hand());
  for (const hand::DorsalMarker& marker : hand::dorsal_markers()) {
    const Vec3 low = landmarks.at(marker.label).reference;
    const Vec3 high = landmarks.at(marker.label, 6.0).reference;
    EXPECT_NEAR((high - low).norm(), 6.0, 1e-9) << marker.label;
    double nearest = 1e9;
    for (const Vec3& v : hand().skin.vertices) nearest = std::min(nearest, (v - high).norm());
    EXPECT_GT(nearest, 5.0) << marker.label;  // nowhere else near: it is outside
  }
}

TEST_F(LandmarksTest, PointsGoWithTheSkinOrTheirPart) {
  // Any posture: points on vertices are where pose_skin() has these vertices, points of a part
  // where pose_skeleton() has that part.
  std::vector<hand::HandPoint> points;
  for (int v = 0; v < hand().skin.vertex_count(); v += 97)
    points.push_back(hand::skin_point(hand(), v));
  const std::size_t on_skin = points.size();
  const Vec3 p(10, 150, 20);
  points.push_back(hand::part_point("index_distal", p));
  points.push_back(hand::part_point("thumb_metacarpal", p));
  points.push_back(hand::part_point("thumb_distal", p));
  points.push_back(hand::part_point("forearm", p));
  points.push_back(hand::part_point("palm", p));
  const hand::PosablePoints posable(hand(), points);
  hand::Posture posture = *hand::named_posture(hand().skeleton, "tripod");
  posture[hand::Dof::kWristFlexion] = 0.5;
  posture[hand::Dof::kWristPronation] = -0.3;
  const std::vector<Vec3> posed = posable.pose(posture);
  const std::vector<Vec3> skin = hand::pose_skin(hand(), posture);
  for (std::size_t i = 0; i < on_skin; ++i) {
    EXPECT_LT((posed[i] - skin[97 * i]).norm(), 1e-12);
  }
  const hand::PosedSkeleton skeleton = hand::pose_skeleton(hand().skeleton, posture);
  const auto at = [&](hand::Segment s) {
    return Vec3(skeleton.segment[static_cast<std::size_t>(s)] * p);
  };
  EXPECT_LT((posed[on_skin] - at(hand::Segment::kIndexDistal)).norm(), 1e-9);
  EXPECT_LT((posed[on_skin + 1] - skeleton.thumb_metacarpal * p).norm(), 1e-9);
  EXPECT_LT((posed[on_skin + 2] - at(hand::Segment::kThumbDistal)).norm(), 1e-9);
  EXPECT_LT((posed[on_skin + 3] - skeleton.forearm * p).norm(), 1e-9);
  EXPECT_LT((posed[on_skin + 4] - p).norm(), 1e-12);
}

TEST_F(LandmarksTest, UnknownNamesAreAnsweredWithTheNearest) {
  const hand::Landmarks landmarks(hand());
  EXPECT_THAT(message_of([&] { landmarks.at("index_dip_dorsl"); }), HasSubstr("index_dip_dorsal"));
  EXPECT_THAT(message_of([&] { landmarks.at("elbow"); }), HasSubstr("index_dip_dorsal"));
  EXPECT_THAT(message_of([&] { hand::part_point("index_distl", Vec3::Zero()); }),
              HasSubstr("index_distal"));
  EXPECT_THAT(message_of([&] { hand::skin_point(hand(), 1000000); }), HasSubstr("1000000"));
}

}  // namespace
}  // namespace palmar::tests
