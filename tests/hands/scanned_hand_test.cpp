// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/scanned_hand.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/repair/self_intersection.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/records/hand/hand_file.h"
#include "subject_fixture.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

Vec3 in_mirror(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }

geometry::TriangleMesh in_mirror(geometry::TriangleMesh mesh) {
  for (Vec3& v : mesh.vertices) v = in_mirror(v);
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// What a scanner without error would show of a subject, with the noise of a good surface. Its
/// skin moves by rules that no Hand knows. All is seen in a mirror: a left hand's.
capture::ScanSurfaces perfect_scan(const phantom::MriSubject& subject, hand::ScanPosture posture) {
  const phantom::SubjectPosture& truth = subject.postures.at(posture);
  capture::ScanSurfaces scan;
  scan.side = hand::Side::kLeft;
  scan.skin = in_mirror(truth.skin);
  RandomStream random(5, static_cast<std::uint64_t>(posture));
  const std::vector<Vec3> normal = geometry::vertex_normals(scan.skin);
  for (std::size_t v = 0; v < normal.size(); ++v) {
    scan.skin.vertices[v] += 0.1 * random.normal() * normal[v];
  }
  for (const hand::Bone& bone : subject.bones) {
    capture::ScannedBone scanned{bone.name, bone.mesh, false};
    for (Vec3& v : scanned.mesh.vertices) v = truth.bone.at(bone.name) * v;
    scanned.mesh = in_mirror(scanned.mesh);
    scan.bones.push_back(std::move(scanned));
  }
  for (const Vec3& marker : truth.markers) scan.markers.push_back(in_mirror(marker));
  std::reverse(scan.markers.begin(), scan.markers.end());
  return scan;
}

class ScannedHandTest : public TemplateTest {
 protected:
  struct Made {
    std::map<hand::ScanPosture, capture::ScanSurfaces> scans;
    capture::MeasuredJoints joints;
    capture::ScannedHand scanned;
  };
  /// A left hand, so that the model is mirrored on the way, in two postures.
  static const Made& made() {
    static const Made result = [] {
      Made m;
      for (const hand::ScanPosture p :
           {hand::ScanPosture::kReference, hand::ScanPosture::kThumbFlexion}) {
        m.scans[p] = perfect_scan(test_subject(hand()), p);
      }
      // One of them fell off, and something is taken for a marker.
      m.scans[hand::ScanPosture::kThumbFlexion].markers.pop_back();
      m.scans[hand::ScanPosture::kThumbFlexion].markers.push_back(
          m.scans[hand::ScanPosture::kThumbFlexion].markers.front() + Vec3(30.0, 0.0, 0.0));
      const hand::Hand model = hand::mirrored(hand());
      const std::map<hand::ScanPosture, std::vector<capture::BoneMotion>> motions{
          {hand::ScanPosture::kThumbFlexion,
           capture::track_bones(m.scans.at(hand::ScanPosture::kReference),
                                m.scans.at(hand::ScanPosture::kThumbFlexion))}};
      m.joints = capture::measure_joints(m.scans, motions, model);
      m.scanned = capture::make_scanned_hand(hand(), m.scans, m.joints);
      return m;
    }();
    return result;
  }
};

TEST_F(ScannedHandTest, SkinLiesOnTheTrueOne) {
  const capture::ScannedHand& scanned = made().scanned;
  EXPECT_LT(scanned.registration_mean, 0.2);
  EXPECT_LT(scanned.registration_p95, 0.6);
  EXPECT_THAT(scanned.notes,
              testing::Not(testing::Contains(testing::HasSubstr("is more than 2 mm"))));
  const geometry::ClosestPointQuery truth(
      in_mirror(test_subject(hand()).postures.at(hand::ScanPosture::kReference).skin));
  double sum = 0.0, worst = 0.0;
  int count = 0;
  for (const Vec3& v : scanned.hand.skin.vertices) {
    if (v.y() < 5.0) continue;  // the forearm's cut
    const double d = truth.closest(scanned.patient_from_hand * v)->distance;
    sum += d;
    worst = std::max(worst, d);
    ++count;
  }
  EXPECT_LT(sum / count, 0.2);
  EXPECT_LT(worst, 1.0);
}

TEST_F(ScannedHandTest, SkinIsSound) {
  const geometry::TriangleMesh& skin = made().scanned.hand.skin;
  geometry::require_closed_manifold(skin, "skin");
  EXPECT_TRUE(geometry::find_self_crossings(skin).empty());
  EXPECT_GT(geometry::signed_volume(skin), 1e5);
  std::vector<double> angles = geometry::smallest_angles(skin);
  std::sort(angles.begin(), angles.end());
  EXPECT_GT(angles[angles.size() / 100], 0.4);  // rad; the template's are 0.53
}

TEST_F(ScannedHandTest, DimensionsAreThePersons) {
  double sum = 0.0;
  for (const hand::HandDimension d : hand::all_hand_dimensions()) {
    const double error = hand::value_of(made().scanned.hand.dimensions, d) -
                         hand::value_of(test_subject(hand()).dimensions, d);
    // Joint centres differ by half a millimetre, webs and flat fingertips add to that.
    EXPECT_LT(std::abs(error), 0.9) << name_of(d);
    sum += std::abs(error);
  }
  EXPECT_LT(sum / static_cast<double>(hand::all_hand_dimensions().size()), 0.3);
}

TEST_F(ScannedHandTest, MarkersAndSkinCorrectTheThumbBall) {
  const capture::ScannedHand& scanned = made().scanned;
  ASSERT_EQ(scanned.skin_errors.size(), 1U);
  const capture::SkinError& error = scanned.skin_errors[0];
  EXPECT_EQ(error.posture, hand::ScanPosture::kThumbFlexion);
  EXPECT_LT(error.corrected.value(), 0.6);
  EXPECT_LT(error.by_markers.value(), error.skinning_only);
  EXPECT_GT(error.skinning_only, 3.0 * error.corrected.value());
  EXPECT_THAT(scanned.notes, testing::Contains(testing::HasSubstr("limit of extension was not")));
  EXPECT_THAT(scanned.notes, testing::Contains(testing::HasSubstr("by 11 markers")));
}

TEST_F(ScannedHandTest, BonesAreTheScans) {
  const hand::Hand& result = made().scanned.hand;
  EXPECT_EQ(result.side, hand::Side::kLeft);
  ASSERT_EQ(result.bones.size(), hand().bones.size());
  for (std::size_t b = 0; b < result.bones.size(); ++b) {
    const hand::Bone& bone = result.bones[b];
    EXPECT_EQ(bone.segment, hand().bones[b].segment) << bone.name;
    const auto truth =
        std::find_if(test_subject(hand()).bones.begin(), test_subject(hand()).bones.end(),
                     [&](const hand::Bone& other) { return other.name == bone.name; });
    if (truth == test_subject(hand()).bones.end()) continue;
    EXPECT_EQ(bone.mesh.triangles, in_mirror(truth->mesh).triangles) << bone.name;
    EXPECT_NEAR((made().scanned.patient_from_hand * bone.mesh.vertices[0] -
                 in_mirror(truth->mesh.vertices[0]))
                    .norm(),
                0.0, 1e-9)
        << bone.name;
  }
}

TEST_F(ScannedHandTest, IsAHandLikeAnyOther) {
  const hand::Hand& result = made().scanned.hand;
  const hand::Hand again = records::parse_hand(records::format_hand(result), "scanned");
  EXPECT_EQ(again.skin.vertices, result.skin.vertices);
  EXPECT_EQ(again.thumb_ball.marker, result.thumb_ball.marker);
  const std::vector<Vec3> rest = hand::pose_skin(result, hand::reference_posture(result.skeleton));
  for (std::size_t v = 0; v < rest.size(); ++v) {
    ASSERT_LT((rest[v] - result.skin.vertices[v]).norm(), 1e-9);
  }
  const hand::HandInstance larger = hand::make_hand_instance(
      result,
      {{{hand::DimensionKind::kHandLength}, 1.05 * result.dimensions.hand_length},
       {{hand::DimensionKind::kHandCircumference}, 1.03 * result.dimensions.hand_circumference}});
  EXPECT_LT(larger.largest_miss, 0.1);
  EXPECT_TRUE(geometry::find_self_crossings(larger.hand.skin).empty());
}

TEST_F(ScannedHandTest, NeedsTheReferenceScan) {
  try {
    capture::make_scanned_hand(hand(), {}, made().joints);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "hand from scans: there is no scan of the reference posture");
  }
}

TEST_F(ScannedHandTest, ReportsJointsThatDoNotBelongToTheSkin) {
  capture::MeasuredJoints elsewhere = made().joints;
  elsewhere.patient_from_hand.translation += Vec3(60.0, 0.0, 0.0);
  EXPECT_THROW(capture::make_scanned_hand(hand(), made().scans, elsewhere), InputError);
}

}  // namespace
}  // namespace palmar::tests
