// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The phantom's person, held to what is true of every hand: bones are rigid and apart, skin keeps
// its volume and covers the bones.
#include "hands/phantom/mri/mri_subject.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <tuple>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/repair/self_intersection.h"
#include "subject_fixture.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

class MriSubjectTest : public TemplateTest {
 protected:
  static const phantom::MriSubject& subject() { return test_subject(hand()); }
  static const phantom::MriSubject& left() {
    static const phantom::MriSubject made =
        phantom::make_mri_subject(hand(), {.seed = 3, .side = hand::Side::kLeft, .markers = 0});
    return made;
  }
  static const phantom::SubjectPosture& at(hand::ScanPosture posture) {
    return subject().postures.at(posture);
  }
  static geometry::TriangleMesh posed(const phantom::MriSubject& who, const hand::Bone& bone,
                                      hand::ScanPosture posture) {
    geometry::TriangleMesh mesh = bone.mesh;
    const geometry::Rigid3& motion = who.postures.at(posture).bone.at(bone.name);
    for (Vec3& v : mesh.vertices) v = motion * v;
    return mesh;
  }
};

// Least distance between bones in a posture, mm; negative where they overlap.
double least_gap(const std::vector<geometry::TriangleMesh>& bones) {
  std::vector<std::unique_ptr<geometry::MeshDistance>> distance;
  for (const geometry::TriangleMesh& bone : bones)
    distance.push_back(std::make_unique<geometry::MeshDistance>(bone));
  double least = 3.0;
  for (std::size_t i = 0; i < bones.size(); ++i) {
    for (std::size_t j = 0; j < bones.size(); ++j) {
      if (i == j) continue;
      const Box3 box = distance[j]->bounding_box();
      if (geometry::bounding_box(bones[i]).exteriorDistance(box) > 1.0) continue;
      for (const Vec3& v : bones[i].vertices) {
        if (box.exteriorDistance(v) > 1.0) continue;
        geometry::DistanceSample sample;
        distance[j]->sample({&v, 1}, 1.0, {&sample, 1});
        least = std::min(least, sample.distance);
      }
    }
  }
  return least;
}

TEST_F(MriSubjectTest, HasAllBonesAndPostures) {
  EXPECT_EQ(subject().postures.size(), static_cast<std::size_t>(hand::kScanPostureCount));
  EXPECT_EQ(subject().bones.size(), 29U);
  for (const hand::Bone& bone : subject().bones) {
    EXPECT_NO_THROW(geometry::require_closed_manifold(bone.mesh, bone.name));
    EXPECT_GT(geometry::signed_volume(bone.mesh), 0.0) << bone.name;
    for (const auto& [posture, scan] : subject().postures)
      EXPECT_EQ(scan.bone.count(bone.name), 1U);
  }
  // ANSUR II: hands of 145 to 239 mm length, 152 to 248 mm girth.
  EXPECT_GT(subject().dimensions.hand_length, 145.0);
  EXPECT_LT(subject().dimensions.hand_length, 239.0);
  EXPECT_GT(subject().dimensions.hand_circumference, 152.0);
  EXPECT_LT(subject().dimensions.hand_circumference, 248.0);
}

TEST_F(MriSubjectTest, SkinStaysClosedAndKeepsItsVolume) {
  const double volume = geometry::signed_volume(at(hand::ScanPosture::kReference).skin);
  EXPECT_GT(volume, 2.5e5);  // mm^3; a hand with part of the forearm
  for (const auto& [posture, scan] : subject().postures) {
    SCOPED_TRACE(name_of(posture));
    EXPECT_NO_THROW(geometry::require_closed_manifold(scan.skin, "skin"));
    EXPECT_EQ(scan.skin.triangles, at(hand::ScanPosture::kReference).skin.triangles);
    EXPECT_NEAR(geometry::signed_volume(scan.skin), volume, 0.03 * volume);
    EXPECT_LT(geometry::crossing_depth(scan.skin).deepest, 1.0);  // mm
  }
}

TEST_F(MriSubjectTest, BonesAreApartAndCoveredInEveryPosture) {
  for (const auto& [posture, scan] : subject().postures) {
    SCOPED_TRACE(name_of(posture));
    const geometry::MeshDistance skin(scan.skin);
    std::vector<geometry::TriangleMesh> bones;
    for (const hand::Bone& bone : subject().bones) {
      bones.push_back(posed(subject(), bone, posture));
      double cover = 1.0;
      for (std::size_t v = 0; v < bones.back().vertices.size(); v += 4) {
        geometry::DistanceSample sample;
        skin.sample({&bones.back().vertices[v], 1}, 1.0, {&sample, 1});
        cover = std::min(cover, -sample.distance);
      }
      EXPECT_GT(cover, 0.6) << bone.name;  // mm; 1.5 wanted, less between the skin's vertices
    }
    EXPECT_GT(least_gap(bones), 0.5);  // mm
  }
}

TEST_F(MriSubjectTest, AnotherPersonDiffersAndItsBonesAreApartToo) {
  for (const hand::ScanPosture posture :
       {hand::ScanPosture::kFingerFlexion, hand::ScanPosture::kThumbFlexion}) {
    std::vector<geometry::TriangleMesh> bones;
    for (const hand::Bone& bone : left().bones) bones.push_back(posed(left(), bone, posture));
    EXPECT_GT(least_gap(bones), 0.5) << name_of(posture);
  }
  EXPECT_TRUE(left().postures.at(hand::ScanPosture::kReference).markers.empty());
  EXPECT_GT(std::abs(left().dimensions.hand_length - subject().dimensions.hand_length), 0.5);
  EXPECT_GT(std::abs(geometry::signed_volume(left().bones[5].mesh) -
                     geometry::signed_volume(subject().bones[5].mesh)),
            1.0);
}

TEST_F(MriSubjectTest, MarkersSitOnTheSkinOfTheThumbBall) {
  for (const auto& [posture, scan] : subject().postures) {
    const bool has = posture != hand::ScanPosture::kFingerFlexion &&
                     posture != hand::ScanPosture::kFingerAbduction &&
                     posture != hand::ScanPosture::kGrasp;
    ASSERT_EQ(scan.markers.size(), has ? 12U : 0U) << name_of(posture);
    const geometry::MeshDistance skin(scan.skin);
    for (const Vec3& marker : scan.markers) {
      EXPECT_NEAR(skin.at(marker).distance, 2.5, 0.3) << name_of(posture);  // radius, mm
    }
  }
  const std::vector<Vec3>& markers = at(hand::ScanPosture::kReference).markers;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT((markers[i] - markers[j]).norm(), 7.0);
  }
}

TEST_F(MriSubjectTest, ThumbBallSwellsWithFlexion) {
  // Between the skin below the first marker and the metacarpal.
  const auto thickness = [&](hand::ScanPosture posture) {
    const auto bone = std::find_if(subject().bones.begin(), subject().bones.end(),
                                   [](const hand::Bone& b) { return b.is_thumb_metacarpal; });
    return geometry::MeshDistance(posed(subject(), *bone, posture))
        .at(at(posture).markers[0])
        .distance;
  };
  const double more =
      thickness(hand::ScanPosture::kThumbFlexion) - thickness(hand::ScanPosture::kReference);
  EXPECT_GT(more, 2.0);  // mm; the swelling is asked for as 3 to 6 mm against skin that follows
  EXPECT_LT(more, 7.0);
  EXPECT_LT(thickness(hand::ScanPosture::kThumbExtension),
            thickness(hand::ScanPosture::kReference));
}

TEST_F(MriSubjectTest, TheGraspTouchesABarAllRound) {
  const geometry::TriangleMesh& bar = at(hand::ScanPosture::kGrasp).product;
  ASSERT_NO_THROW(geometry::require_closed_manifold(bar, "bar"));
  EXPECT_TRUE(at(hand::ScanPosture::kReference).product.vertices.empty());
  const geometry::TriangleMesh& skin = at(hand::ScanPosture::kGrasp).skin;
  const geometry::MeshDistance to_bar(bar);
  const std::vector<double> area = geometry::vertex_areas(skin);
  double touching = 0.0;
  for (std::size_t v = 0; v < area.size(); ++v) {
    geometry::DistanceSample sample;
    to_bar.sample({&skin.vertices[v], 1}, 3.0, {&sample, 1});
    EXPECT_GT(sample.distance, -0.1);  // mm; the bar's mesh is a prism of 72 sides
    if (std::abs(sample.distance) < 2.0) touching += area[v];
  }
  // Xie 2014, 5.4: 3700 to 4000 mm^2 on a cylinder of 35 mm.
  EXPECT_GT(touching, 2000.0);
  EXPECT_LT(touching, 6000.0);
}

TEST_F(MriSubjectTest, HingesTurnAboutTheirTrueAxes) {
  const auto relative = [&](const char* distal, const char* proximal, hand::ScanPosture posture) {
    const geometry::Rigid3 motion =
        at(posture).bone.at(proximal).inverse() * at(posture).bone.at(distal);
    return Eigen::AngleAxisd(motion.rotation);
  };
  for (const auto& [joint, distal, proximal, posture] :
       {std::tuple{"index_pip_flexion", "index_middle_phalanx", "index_proximal_phalanx",
                   hand::ScanPosture::kFingerFlexion},
        {"ring_dip_flexion", "ring_distal_phalanx", "ring_middle_phalanx",
         hand::ScanPosture::kFingerFlexion},
        {"thumb_ip_flexion", "thumb_distal_phalanx", "thumb_proximal_phalanx",
         hand::ScanPosture::kThumbFlexion}}) {
    const Eigen::AngleAxisd turn = relative(distal, proximal, posture);
    const auto axis = std::find_if(subject().axes.begin(), subject().axes.end(),
                                   [&joint = joint](const auto& a) { return a.joint == joint; });
    ASSERT_NE(axis, subject().axes.end()) << joint;
    EXPECT_GT(turn.axis().dot(axis->axis), std::cos(2.0 * std::numbers::pi / 180.0)) << joint;
    const hand::Dof dof = *hand::dof_named(joint);
    const double asked =
        subject().angles.at(posture)[static_cast<std::size_t>(dof)] -
        subject().angles.at(hand::ScanPosture::kReference)[static_cast<std::size_t>(dof)];
    EXPECT_NEAR(turn.angle(), asked, 0.01) << joint;  // rad
  }
}

TEST_F(MriSubjectTest, LiesProneWithTheArmOverTheHead) {
  // Fingers towards +z; the thumb of a right hand towards the patient's left (+x), of a left hand
  // to the right; the palm faces down, to -y, so bent fingertips lie lower than knuckles.
  for (const phantom::MriSubject* who :
       std::array<const phantom::MriSubject*, 2>{&subject(), &left()}) {
    const auto middle_of = [&](const char* name) {
      const auto bone = std::find_if(who->bones.begin(), who->bones.end(),
                                     [&](const hand::Bone& b) { return b.name == name; });
      return geometry::centre_of_volume(bone->mesh);
    };
    EXPECT_GT(middle_of("middle_distal_phalanx").z(), middle_of("capitate").z() + 90.0);
    EXPECT_LT(middle_of("middle_distal_phalanx").y(), middle_of("middle_metacarpal").y());
    const double side = who->side == hand::Side::kRight ? 1.0 : -1.0;
    EXPECT_GT(side * middle_of("thumb_distal_phalanx").x(),
              side * middle_of("index_metacarpal").x());
    EXPECT_GT(side * middle_of("index_metacarpal").x(), side * middle_of("little_metacarpal").x());
  }
}

TEST_F(MriSubjectTest, ALeftHandBendsLikeARightOne) {
  // The axis of flexion of a left hand, turned by the true angle, carries the index fingertip
  // towards the palm as that of a right hand does.
  EXPECT_GT(geometry::signed_volume(left().postures.at(hand::ScanPosture::kGrasp).skin), 0.0);
  for (const phantom::MriSubject* who :
       std::array<const phantom::MriSubject*, 2>{&subject(), &left()}) {
    const auto axis = std::find_if(who->axes.begin(), who->axes.end(),
                                   [](const auto& a) { return a.joint == "index_mcp_flexion"; });
    ASSERT_NE(axis, who->axes.end());
    const geometry::Rigid3& motion =
        who->postures.at(hand::ScanPosture::kFingerFlexion).bone.at("index_proximal_phalanx");
    const geometry::Rigid3& palm =
        who->postures.at(hand::ScanPosture::kFingerFlexion).bone.at("capitate");
    const Eigen::AngleAxisd turn((palm.inverse() * motion).rotation);
    EXPECT_GT(turn.axis().dot(axis->axis), 0.98);
  }
}

TEST_F(MriSubjectTest, SameSeedSameBytesOnAnyNumberOfThreads) {
  const int before = thread_count();
  set_thread_count(1);
  const phantom::MriSubject one =
      phantom::make_mri_subject(hand(), {.seed = 1, .has_fixture = false});
  set_thread_count(before);
  for (const auto& [posture, scan] : subject().postures) {
    const phantom::SubjectPosture& again = one.postures.at(posture);
    EXPECT_EQ(again.skin.vertices, scan.skin.vertices) << name_of(posture);
    ASSERT_EQ(again.parts.size(), scan.parts.size());
    for (std::size_t p = 0; p < scan.parts.size(); ++p) {
      EXPECT_EQ(again.parts[p].mesh.vertices, scan.parts[p].mesh.vertices);
    }
  }
}

TEST_F(MriSubjectTest, EveryPartCanBeImagedAndBoneIsDark) {
  const phantom::SubjectPosture& scan = at(hand::ScanPosture::kReference);
  imaging::VolumeGrid grid{.size = {70, 60, 150}, .spacing = Vec3::Constant(2.0)};
  grid.origin = geometry::bounding_box(scan.skin).center() - Vec3(69.0, 59.0, 149.0);
  const imaging::Volume image =
      phantom::image_of(scan.parts, grid, {.subsamples = 2, .snr = 0.0, .bias = 0.0, .seed = 1});
  // Nothing but markers shows outside of the skin; the skin's volume shows.
  double lit = 0.0;
  for (const float v : image.value) lit += std::min(1.0, static_cast<double>(v) / 5.0);
  const double markers = 12 * 4.0 / 3.0 * std::numbers::pi * std::pow(2.5, 3);
  const double volume = geometry::signed_volume(scan.skin) + markers;
  EXPECT_NEAR(8.0 * lit, volume, 0.12 * volume);  // voxels at the skin count as whole: 2 mm
}

TEST_F(MriSubjectTest, RefusesTooManyMarkers) {
  EXPECT_THROW(phantom::make_mri_subject(hand(), {.markers = 41}), UsageError);
}

}  // namespace
}  // namespace palmar::tests
