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

namespace palmar {
namespace {

Vec3 in_mirror(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }

TriangleMesh in_mirror(TriangleMesh mesh) {
  for (Vec3& v : mesh.vertices) v = in_mirror(v);
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// What a scanner without error would show of a subject, with the noise of a good surface. Its
/// skin moves by rules that no Hand knows. All is seen in a mirror: a left hand's.
ScanSurfaces perfect_scan(const MriSubject& subject, ScanPosture posture) {
  const SubjectPosture& truth = subject.postures.at(posture);
  ScanSurfaces scan;
  scan.side = Side::kLeft;
  scan.skin = in_mirror(truth.skin);
  RandomStream random(5, static_cast<std::uint64_t>(posture));
  const std::vector<Vec3> normal = vertex_normals(scan.skin);
  for (std::size_t v = 0; v < normal.size(); ++v) {
    scan.skin.vertices[v] += 0.1 * random.normal() * normal[v];
  }
  for (const Bone& bone : subject.bones) {
    ScannedBone scanned{bone.name, bone.mesh, false};
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
    std::map<ScanPosture, ScanSurfaces> scans;
    MeasuredJoints joints;
    ScannedHand scanned;
  };
  /// A left hand, so that the model is mirrored on the way, in two postures.
  static const Made& made() {
    static const Made result = [] {
      Made m;
      for (const ScanPosture p : {ScanPosture::kReference, ScanPosture::kThumbFlexion}) {
        m.scans[p] = perfect_scan(test_subject(hand()), p);
      }
      // One of them fell off, and something is taken for a marker.
      m.scans[ScanPosture::kThumbFlexion].markers.pop_back();
      m.scans[ScanPosture::kThumbFlexion].markers.push_back(
          m.scans[ScanPosture::kThumbFlexion].markers.front() + Vec3(30.0, 0.0, 0.0));
      const Hand model = mirrored(hand());
      const std::map<ScanPosture, std::vector<BoneMotion>> motions{
          {ScanPosture::kThumbFlexion, track_bones(m.scans.at(ScanPosture::kReference),
                                                   m.scans.at(ScanPosture::kThumbFlexion))}};
      m.joints = measure_joints(m.scans, motions, model);
      m.scanned = make_scanned_hand(hand(), m.scans, m.joints);
      return m;
    }();
    return result;
  }
};

TEST_F(ScannedHandTest, SkinLiesOnTheTrueOne) {
  const ScannedHand& scanned = made().scanned;
  EXPECT_LT(scanned.registration_mean, 0.2);
  EXPECT_LT(scanned.registration_p95, 0.6);
  EXPECT_THAT(scanned.notes,
              testing::Not(testing::Contains(testing::HasSubstr("is more than 2 mm"))));
  const ClosestPointQuery truth(
      in_mirror(test_subject(hand()).postures.at(ScanPosture::kReference).skin));
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
  const TriangleMesh& skin = made().scanned.hand.skin;
  require_closed_manifold(skin, "skin");
  EXPECT_TRUE(find_self_crossings(skin).empty());
  EXPECT_GT(signed_volume(skin), 1e5);
  std::vector<double> angles = smallest_angles(skin);
  std::sort(angles.begin(), angles.end());
  EXPECT_GT(angles[angles.size() / 100], 0.4);  // rad; the template's are 0.53
}

TEST_F(ScannedHandTest, DimensionsAreThePersons) {
  double sum = 0.0;
  for (const HandDimension d : all_hand_dimensions()) {
    const double error =
        value_of(made().scanned.hand.dimensions, d) - value_of(test_subject(hand()).dimensions, d);
    // Joint centres differ by half a millimetre, webs and flat fingertips add to that.
    EXPECT_LT(std::abs(error), 0.9) << name_of(d);
    sum += std::abs(error);
  }
  EXPECT_LT(sum / static_cast<double>(all_hand_dimensions().size()), 0.3);
}

TEST_F(ScannedHandTest, MarkersAndSkinCorrectTheThumbBall) {
  const ScannedHand& scanned = made().scanned;
  ASSERT_EQ(scanned.skin_errors.size(), 1U);
  const SkinError& error = scanned.skin_errors[0];
  EXPECT_EQ(error.posture, ScanPosture::kThumbFlexion);
  EXPECT_LT(error.corrected.value(), 0.6);
  EXPECT_LT(error.by_markers.value(), error.skinning_only);
  EXPECT_GT(error.skinning_only, 3.0 * error.corrected.value());
  EXPECT_THAT(scanned.notes, testing::Contains(testing::HasSubstr("limit of extension was not")));
  EXPECT_THAT(scanned.notes, testing::Contains(testing::HasSubstr("by 11 markers")));
}

TEST_F(ScannedHandTest, BonesAreTheScans) {
  const Hand& result = made().scanned.hand;
  EXPECT_EQ(result.side, Side::kLeft);
  ASSERT_EQ(result.bones.size(), hand().bones.size());
  for (std::size_t b = 0; b < result.bones.size(); ++b) {
    const Bone& bone = result.bones[b];
    EXPECT_EQ(bone.segment, hand().bones[b].segment) << bone.name;
    const auto truth =
        std::find_if(test_subject(hand()).bones.begin(), test_subject(hand()).bones.end(),
                     [&](const Bone& other) { return other.name == bone.name; });
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
  const Hand& result = made().scanned.hand;
  const Hand again = parse_hand(format_hand(result), "scanned");
  EXPECT_EQ(again.skin.vertices, result.skin.vertices);
  EXPECT_EQ(again.thumb_ball.marker, result.thumb_ball.marker);
  const std::vector<Vec3> rest = pose_skin(result, reference_posture(result.skeleton));
  for (std::size_t v = 0; v < rest.size(); ++v) {
    ASSERT_LT((rest[v] - result.skin.vertices[v]).norm(), 1e-9);
  }
  const HandInstance larger = make_hand_instance(
      result, {{{DimensionKind::kHandLength}, 1.05 * result.dimensions.hand_length},
               {{DimensionKind::kHandCircumference}, 1.03 * result.dimensions.hand_circumference}});
  EXPECT_LT(larger.largest_miss, 0.1);
  EXPECT_TRUE(find_self_crossings(larger.hand.skin).empty());
}

TEST_F(ScannedHandTest, NeedsTheReferenceScan) {
  try {
    make_scanned_hand(hand(), {}, made().joints);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "hand from scans: there is no scan of the reference posture");
  }
}

TEST_F(ScannedHandTest, ReportsJointsThatDoNotBelongToTheSkin) {
  MeasuredJoints elsewhere = made().joints;
  elsewhere.patient_from_hand.translation += Vec3(60.0, 0.0, 0.0);
  EXPECT_THROW(make_scanned_hand(hand(), made().scans, elsewhere), InputError);
}

}  // namespace
}  // namespace palmar
