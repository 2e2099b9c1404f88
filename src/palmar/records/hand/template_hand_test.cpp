// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The template hand from the real asset. Stands in io because reading the asset does.
#include "palmar/hand/template/template_hand.h"
#include "palmar/hand/mirror.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/repair/self_intersection.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/hand/template/hand_frame.h"
#include "palmar/records/hand/hand_asset.h"

namespace palmar::records {
namespace {

using ::testing::HasSubstr;

std::string asset_path() {
  return std::string(PALMAR_SOURCE_DIR) +
         "/node_modules/@webxr-input-profiles/assets/dist/profiles/generic-hand/right.glb";
}

class TemplateHand : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(asset_path())) {
      GTEST_SKIP() << "the generic hand is not installed (npm ci fetches it)";
    }
  }
  /// Coarser than the default, so that the sanitized build stays quick.
  static const hand::Hand& hand() {
    static const hand::Hand made =
        hand::build_template(read_hand_asset(asset_path()), {.edge_length = 3.0});
    return made;
  }
};

geometry::TriangleMesh posed(const hand::Hand& hand, const hand::Posture& posture) {
  geometry::TriangleMesh skin = hand.skin;
  skin.vertices = hand::pose_skin(hand, posture);
  return skin;
}

hand::Posture full_fist(const hand::Skeleton& skeleton) {
  hand::Posture posture = hand::reference_posture(skeleton);
  for (int d = static_cast<int>(hand::Dof::kIndexMcpFlexion); d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    if (name_of(dof).ends_with("flexion")) posture[dof] = skeleton.dof(dof).upper;
  }
  return posture;
}

TEST_F(TemplateHand, IsAClosedRightHandOfHumanSize) {
  geometry::require_closed_manifold(hand().skin, "template");
  const hand::Skeleton& s = hand().skeleton;
  EXPECT_EQ(s.joint(hand::JointId::kWrist).centre, Vec3::Zero());
  EXPECT_GT(s.fingertips[0].x(), s.fingertips[1].x());  // thumb radial
  EXPECT_GT(s.fingertips[1].x(), s.fingertips[4].x());  // index radial of little finger
  EXPECT_GT(s.fingertips[2].y(), s.fingertips[1].y());  // middle finger longest
  EXPECT_GT(s.fingertips[0].z(), s.joint(hand::JointId::kThumbCmc).centre.z());  // thumb palmar
  // DESIGN.md: about 190 mm long, 335 ml with the wrist.
  EXPECT_NEAR(s.fingertips[2].y(), 190, 10);
  EXPECT_NEAR(geometry::signed_volume(hand().skin) / 1000, 335, 12);
}

TEST_F(TemplateHand, ReferencePostureMovesNothing) {
  const std::vector<Vec3> skin = hand::pose_skin(hand(), hand::reference_posture(hand().skeleton));
  EXPECT_EQ(skin, hand().skin.vertices);
}

TEST_F(TemplateHand, EveryAngleHasASourceAndARangeAboutTheReference) {
  for (int d = 0; d < hand::kDofCount; ++d) {
    const hand::JointDof& dof = hand().skeleton.dof(static_cast<hand::Dof>(d));
    EXPECT_LE(dof.lower, dof.reference) << name_of(dof.dof);
    EXPECT_GE(dof.upper, dof.reference) << name_of(dof.dof);
    EXPECT_LT(dof.lower, dof.upper) << name_of(dof.dof);
    EXPECT_NEAR(dof.axis.norm(), 1, 1e-12) << name_of(dof.dof);
    EXPECT_THAT(dof.source, HasSubstr("range: ")) << name_of(dof.dof);
  }
}

TEST_F(TemplateHand, FlexionBendsTowardsThePalmAndAbductionTowardsTheThumb) {
  const hand::Skeleton& s = hand().skeleton;
  for (int f = 1; f < hand::kFingerCount; ++f) {
    const Vec3 tip = s.fingertips[f];
    const std::size_t distal = index_of(*hand::segments_of(static_cast<hand::Finger>(f))[2]);
    const int first = static_cast<int>(hand::Dof::kIndexMcpFlexion) + 4 * (f - 1);
    for (const int k : {0, 2, 3}) {
      hand::Posture posture = hand::reference_posture(s);
      posture[static_cast<hand::Dof>(first + k)] += 30 * geometry::kDegree;
      EXPECT_GT((hand::pose_skeleton(s, posture).segment[distal] * tip).z(), tip.z() + 3);
    }
    hand::Posture posture = hand::reference_posture(s);
    posture[static_cast<hand::Dof>(first + 1)] += 10 * geometry::kDegree;
    EXPECT_GT((hand::pose_skeleton(s, posture).segment[distal] * tip).x(), tip.x() + 5);
  }
}

TEST_F(TemplateHand, FlexedFingersConvergeOnTheScaphoid) {
  // Side by side when straight, fingertips of a fist lie closer together than the knuckles.
  const hand::Skeleton& s = hand().skeleton;
  const hand::PosedSkeleton fist = hand::pose_skeleton(s, full_fist(s));
  const auto tip = [&](hand::Finger finger) {
    return Vec3(fist.segment[index_of(*hand::segments_of(finger)[2])] *
                s.fingertips[index_of(finger)]);
  };
  const double tips = (tip(hand::Finger::kIndex) - tip(hand::Finger::kLittle)).norm();
  const double knuckles =
      (s.joint(hand::JointId::kIndexMcp).centre - s.joint(hand::JointId::kLittleMcp).centre).norm();
  EXPECT_LT(tips, knuckles);
}

TEST_F(TemplateHand, WeightsAreSharesAndListedInOrder) {
  ASSERT_EQ(std::ssize(hand().weights), hand::kJointCount);
  for (std::size_t j = 0; j < hand().weights.size(); ++j) {
    const hand::JointWeights& weights = hand().weights[j];
    EXPECT_EQ(weights.joint, static_cast<hand::JointId>(j));
    EXPECT_TRUE(std::is_sorted(weights.vertex.begin(), weights.vertex.end()));
    for (std::size_t k = 0; k < weights.vertex.size(); ++k) {
      EXPECT_GT(weights.w1[k] * weights.w2[k], 0);
      EXPECT_LE(weights.w1[k], 1);
      EXPECT_LE(weights.w2[k], 1);
    }
  }
}

TEST_F(TemplateHand, FingertipsMoveRigidlyAndNoFingerDragsItsNeighbour) {
  const hand::Skeleton& s = hand().skeleton;
  hand::Posture posture = hand::reference_posture(s);
  posture[hand::Dof::kMiddleMcpFlexion] += 50 * geometry::kDegree;
  posture[hand::Dof::kMiddlePipFlexion] += 40 * geometry::kDegree;
  const hand::PosedSkeleton bones = hand::pose_skeleton(s, posture);
  const std::vector<Vec3> skin = hand::pose_skin(hand(), posture);
  for (std::size_t v = 0; v < skin.size(); ++v) {
    const auto finger = hand::finger_of(hand().segment[v]);
    if (hand().segment[v] == hand::Segment::kMiddleDistal) {
      const Vec3 rigid =
          bones.segment[index_of(hand::Segment::kMiddleDistal)] * hand().skin.vertices[v];
      ASSERT_NEAR((skin[v] - rigid).norm(), 0, 1e-9) << "vertex " << v;  // mm, rounding
    } else if (finger && hand().segment[v] != *hand::segments_of(*finger)[0] &&
               *finger != hand::Finger::kMiddle) {
      ASSERT_EQ(skin[v], hand().skin.vertices[v]) << "vertex " << v;
    }
  }
}

TEST_F(TemplateHand, SomeVerticesAloneGoWhereAllGo) {
  const hand::Posture posture = *hand::named_posture(hand().skeleton, "fist");
  const std::vector<Vec3> all = hand::pose_skin(hand(), posture);
  const std::vector<int> some = {5, 900, 17, 5, hand().skin.vertex_count() - 1};
  const std::vector<Vec3> alone = hand::pose_skin_vertices(hand(), posture, some);
  ASSERT_EQ(alone.size(), some.size());
  for (std::size_t k = 0; k < some.size(); ++k) {
    EXPECT_EQ(alone[k], all[some[k]]);
  }
}

TEST_F(TemplateHand, BendingKeepsTheVolumeWithinFivePercentOfTheFinger) {
  const double straight = geometry::signed_volume(hand().skin);
  // Volumes of the fingers themselves, from sections of about 16 mm over their lengths: 12 to 19
  // ml; the smallest, the little finger, has about 8 ml. 5 % of those, mm^3:
  const double allowed[] = {0.05 * 18000, 0.05 * 16000, 0.05 * 18000, 0.05 * 15000, 0.05 * 9000};
  for (int j = static_cast<int>(hand::JointId::kThumbMp); j < hand::kJointCount; ++j) {
    const hand::Joint& joint = hand().skeleton.joint(static_cast<hand::JointId>(j));
    const hand::JointDof& flexion = joint.dofs.back();
    hand::Posture posture = hand::reference_posture(hand().skeleton);
    posture[flexion.dof] = flexion.upper;
    const std::size_t finger = j < 4 ? 0 : static_cast<std::size_t>((j - 4) / 3 + 1);
    EXPECT_NEAR(geometry::signed_volume(posed(hand(), posture)), straight, allowed[finger])
        << name_of(joint.id);
  }
}

TEST_F(TemplateHand, NamedPosturesAreInRangeAndKeepTheVolumeOfTheHand) {
  const double straight = geometry::signed_volume(hand().skin);
  EXPECT_EQ(hand::posture_names().size(), 10U);
  for (const std::string& name : hand::posture_names()) {
    const auto posture = hand::named_posture(hand().skeleton, name);
    ASSERT_TRUE(posture);
    EXPECT_TRUE(hand::clamp_to_range(hand().skeleton, *posture).clamped.empty()) << name;
    EXPECT_NEAR(geometry::signed_volume(posed(hand(), *posture)) / straight, 1, 0.05) << name;
  }
  EXPECT_FALSE(hand::named_posture(hand().skeleton, "salute"));
}

TEST_F(TemplateHand, OneFingerBentToItsLimitDoesNotCrossItself) {
  for (const char* finger : {"index", "ring"}) {
    hand::Posture posture = hand::reference_posture(hand().skeleton);
    for (const char* joint : {"_pip_flexion", "_dip_flexion"}) {
      const hand::Dof dof = *hand::dof_named(std::string(finger) + joint);
      posture[dof] = hand().skeleton.dof(dof).upper;
    }
    EXPECT_LE(geometry::crossing_depth(posed(hand(), posture)).deepest, 1.0)
        << finger;  // mm, in the crease
  }
}

TEST_F(TemplateHand, MirroredHandTakesTheMirroredPosture) {
  const hand::Hand left = hand::mirrored(hand());
  EXPECT_EQ(left.side, hand::Side::kLeft);
  EXPECT_GT(geometry::signed_volume(left.skin), 0);
  const hand::Posture posture = *hand::named_posture(hand().skeleton, "thumb_to_little");
  const std::vector<Vec3> right_skin = hand::pose_skin(hand(), posture);
  const std::vector<Vec3> left_skin = hand::pose_skin(left, posture);
  for (std::size_t v = 0; v < right_skin.size(); ++v) {
    const Vec3 image(-right_skin[v].x(), right_skin[v].y(), right_skin[v].z());
    ASSERT_NEAR((left_skin[v] - image).norm(), 0, 1e-9) << "vertex " << v;  // mm, rounding
  }
}

TEST_F(TemplateHand, ThumbReachesTheLittleFingertipWithinTheRangeOfMotion) {
  std::vector<int> thumb, little;
  for (int v = 0; v < hand().skin.vertex_count(); ++v) {
    const hand::Region region = hand().region[v];
    if (region == hand::Region::kThumbDistal) thumb.push_back(v);
    if (region == hand::Region::kLittleDistal) little.push_back(v);
  }
  const auto gap = [&](const hand::Posture& posture) {
    const std::vector<Vec3> a = hand::pose_skin_vertices(hand(), posture, thumb);
    const std::vector<Vec3> b = hand::pose_skin_vertices(hand(), posture, little);
    double least = 1e30;
    for (const Vec3& p : a) {
      for (const Vec3& q : b) least = std::min(least, (p - q).norm());
    }
    return least;
  };
  const hand::Dof free[] = {hand::Dof::kThumbCmcFlexion,  hand::Dof::kThumbCmcAbduction,
                            hand::Dof::kThumbMpFlexion,   hand::Dof::kThumbIpFlexion,
                            hand::Dof::kLittleMcpFlexion, hand::Dof::kLittlePipFlexion,
                            hand::Dof::kLittleDipFlexion};
  hand::Posture best = hand::reference_posture(hand().skeleton);
  double least = gap(best);
  for (double step = 16 * geometry::kDegree; step > geometry::kDegree && least > 2.0; step /= 2) {
    for (bool improves = true; improves && least > 2.0;) {
      improves = false;
      for (const hand::Dof dof : free) {
        for (const double turn : {step, -step}) {
          hand::Posture next = best;
          next[dof] += turn;
          next = hand::clamp_to_range(hand().skeleton, next).posture;
          const double reached = gap(next);
          if (reached >= least - 1e-6) continue;
          least = reached;
          best = next;
          improves = true;
        }
      }
    }
  }
  EXPECT_LT(least, 3.0);  // mm between vertices of a mesh of 3 mm: the pads touch
}

TEST_F(TemplateHand, ClampingNamesTheAngleAndKeepsTheRest) {
  hand::Posture posture = hand::reference_posture(hand().skeleton);
  posture[hand::Dof::kIndexPipFlexion] = 130 * geometry::kDegree;
  const hand::ClampedPosture held = hand::clamp_to_range(hand().skeleton, posture);
  ASSERT_EQ(held.clamped.size(), 1U);
  EXPECT_EQ(held.clamped[0].dof, hand::Dof::kIndexPipFlexion);
  EXPECT_NEAR(held.clamped[0].used, 100 * geometry::kDegree, 1e-12);  // clinical norm
  EXPECT_NEAR(held.clamped[0].asked, 130 * geometry::kDegree, 1e-12);
}

TEST_F(TemplateHand, ALeftOrIncompleteAssetIsRefusedByName) {
  hand::HandAsset asset = read_hand_asset(asset_path());
  EXPECT_EQ(asset.frames.size(), 25U);
  hand::HandAsset left = asset;
  for (hand::HandAsset::Frame& frame : left.frames) {
    frame.asset_from_joint.translation.z() *= -1;  // asset: x dorsal, y proximal, z ulnar
  }
  EXPECT_THROW(hand::hand_from_asset(left), InputError);
  asset.frames.erase(asset.frames.begin() + 7);
  try {
    hand::build_template(asset);
    FAIL() << "must throw";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("index-finger-phalanx-intermediate"));
  }
  EXPECT_THROW(hand::build_template(asset, {.edge_length = 0.2}), UsageError);
}

}  // namespace
}  // namespace palmar::records
