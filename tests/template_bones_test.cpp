// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <memory>
#include <tuple>

#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/section.h"
#include "palmar/hand/bones/bones.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/skin/creases.h"
#include "palmar/hand/skin/skinning.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

class TemplateBones : public TemplateTest {
 protected:
  static const hand::Bone& bone(const std::string& name) {
    for (const hand::Bone& b : hand().bones) {
      if (b.name == name) return b;
    }
    throw std::runtime_error("no bone " + name);
  }
};

// Length between the poles, which are the first and the last vertex.
double length_of(const hand::Bone& bone) {
  return (bone.mesh.vertices.back() - bone.mesh.vertices.front()).norm();
}

TEST_F(TemplateBones, AreAllThere) {
  EXPECT_EQ(hand().bones.size(), 14u + 5u + 8u + 2u);
  int phalanges = 0, thumb_metacarpals = 0, forearm = 0;
  for (const hand::Bone& b : hand().bones) {
    phalanges += b.name.find("phalanx") != std::string::npos;
    thumb_metacarpals += b.is_thumb_metacarpal;
    forearm += !b.segment;
    if (b.name.find("phalanx") != std::string::npos) {
      EXPECT_EQ(b.name, std::string(name_of(*b.segment)) + "_phalanx");
    }
  }
  EXPECT_EQ(phalanges, 14);
  EXPECT_EQ(thumb_metacarpals, 1);
  EXPECT_EQ(forearm, 2);
}

TEST_F(TemplateBones, AreClosedManifoldsOfPositiveVolume) {
  for (const hand::Bone& b : hand().bones) {
    const geometry::TopologyReport report = geometry::examine_topology(b.mesh);
    EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented) << b.name;
    EXPECT_EQ(report.euler_number, 2) << b.name;
    EXPECT_GT(geometry::signed_volume(b.mesh), 100.0) << b.name;  // mm^3
    EXPECT_GE(b.mesh.vertex_count(), 200) << b.name;
    EXPECT_LE(b.mesh.vertex_count(), 600) << b.name;
  }
}

TEST_F(TemplateBones, LieInsideTheSkinEverywhere) {
  const geometry::MeshDistance skin(hand().skin);
  for (const hand::Bone& b : hand().bones) {
    double nearest = std::numeric_limits<double>::lowest();
    for (const Vec3& v : b.mesh.vertices) nearest = std::max(nearest, skin.at(v).distance);
    EXPECT_LE(nearest, -1.0) << b.name;  // mm
  }
}

TEST_F(TemplateBones, DoNotTouchEachOther) {
  std::vector<std::unique_ptr<geometry::MeshDistance>> distance;
  for (const hand::Bone& b : hand().bones)
    distance.push_back(std::make_unique<geometry::MeshDistance>(b.mesh));
  for (std::size_t i = 0; i < hand().bones.size(); ++i) {
    for (std::size_t j = 0; j < hand().bones.size(); ++j) {
      if (i == j) continue;
      for (const Vec3& v : hand().bones[i].mesh.vertices) {
        ASSERT_GT(distance[j]->at(v).distance, 0.3)  // mm
            << hand().bones[i].name << " and " << hand().bones[j].name;
      }
    }
  }
}

TEST_F(TemplateBones, HaveTheLengthsOfRadiographs) {
  // Buryanov & Kotiuk 2010, Table I, means of 66 adults, mm. Joints stand
  // half way between these proportions and others with shorter fingertips (joint_placement.h), and
  // the asset's fingertips are short: within 15 % for metacarpals, proximal and middle phalanges;
  // distal ones may be 30 % short.
  struct Row {
    const char* name;
    double length, shorter, longer;
  };
  for (const Row& row :
       {Row{"index_metacarpal", 68.12, 0.85, 1.15}, Row{"middle_metacarpal", 64.60, 0.85, 1.15},
        Row{"ring_metacarpal", 58.00, 0.85, 1.15}, Row{"little_metacarpal", 53.69, 0.85, 1.15},
        Row{"index_proximal_phalanx", 39.78, 0.85, 1.15},
        Row{"middle_proximal_phalanx", 44.63, 0.85, 1.15},
        Row{"ring_proximal_phalanx", 41.37, 0.85, 1.15},
        Row{"little_proximal_phalanx", 32.74, 0.85, 1.15},
        Row{"index_middle_phalanx", 22.38, 0.85, 1.15},
        Row{"middle_middle_phalanx", 26.33, 0.85, 1.15},
        Row{"ring_middle_phalanx", 25.65, 0.85, 1.15},
        Row{"little_middle_phalanx", 18.11, 0.85, 1.15},
        Row{"index_distal_phalanx", 15.82, 0.70, 1.15},
        Row{"middle_distal_phalanx", 17.40, 0.70, 1.15},
        Row{"ring_distal_phalanx", 17.30, 0.70, 1.15},
        Row{"little_distal_phalanx", 15.96, 0.70, 1.15}, Row{"thumb_metacarpal", 46.22, 0.85, 1.15},
        Row{"thumb_distal_phalanx", 21.67, 0.65, 1.15},
        Row{"thumb_proximal_phalanx", 31.57, 0.85, 1.15}}) {
    EXPECT_GT(length_of(bone(row.name)), row.shorter * row.length) << row.name;
    EXPECT_LT(length_of(bone(row.name)), row.longer * row.length) << row.name;
  }
}

TEST_F(TemplateBones, EndAsFarBeforeTheSkinAsOnRadiographs) {
  for (const auto& [name, finger, tissue] :
       {std::tuple{"thumb_distal_phalanx", hand::Finger::kThumb, 5.67},
        std::tuple{"index_distal_phalanx", hand::Finger::kIndex, 3.84},
        std::tuple{"middle_distal_phalanx", hand::Finger::kMiddle, 3.95}}) {
    const Vec3& tip = hand().skeleton.fingertips[static_cast<std::size_t>(finger)];
    EXPECT_NEAR((tip - bone(name).mesh.vertices.back()).norm(), tissue, 0.6) << name;  // 1 SD
  }
}

TEST_F(TemplateBones, FillAFifthOfTheFingertip) {
  // 18 % of the fingertip beyond the DIP crease in cadavers (Murai et al. 1997).
  const hand::HandCreases creases(hand().skin, hand().skeleton);
  const hand::CreasePlane& crease = creases.proximal_crease(hand::Segment::kIndexDistal);
  const auto volume_beyond = [&](const geometry::TriangleMesh& mesh, double reach) {
    // Sum of sections, 0.25 mm apart; of the skin only the curve round the finger.
    double volume = 0.0;
    for (double x = 0.125; x < reach; x += 0.25) {
      for (const geometry::SectionCurve& c :
           geometry::plane_section(mesh, crease.point + x * crease.normal, crease.normal)) {
        const Vec3 off = geometry::curve_centre(c) - crease.point;
        if ((off - crease.normal.dot(off) * crease.normal).norm() > 10.0) continue;
        double area = 0.0;
        for (std::size_t i = 0; i < c.point.size(); ++i) {
          area +=
              0.5 * crease.normal.dot((c.point[i] - crease.point)
                                          .cross(c.point[(i + 1) % c.point.size()] - crease.point));
        }
        volume += 0.25 * area;
      }
    }
    return volume;
  };
  const double skin = volume_beyond(hand().skin, 40.0);
  const double bones = volume_beyond(bone("index_distal_phalanx").mesh, 40.0) +
                       volume_beyond(bone("index_middle_phalanx").mesh, 40.0);
  EXPECT_GT(bones / skin, 0.12);
  EXPECT_LT(bones / skin, 0.24);
}

TEST_F(TemplateBones, LieNearerToTheBackOfTheFinger) {
  const geometry::MeshDistance skin(hand().skin);
  for (const char* name : {"index_distal_phalanx", "middle_distal_phalanx", "index_middle_phalanx",
                           "middle_proximal_phalanx", "middle_metacarpal"}) {
    double palmar = 1e9, dorsal = 1e9;
    const geometry::TriangleMesh& mesh = bone(name).mesh;
    const std::vector<Vec3> normal = geometry::vertex_normals(mesh);
    for (std::size_t i = 0; i < normal.size(); ++i) {
      const double depth = -skin.at(mesh.vertices[i]).distance;
      if (normal[i].z() > 0.8) palmar = std::min(palmar, depth);
      if (normal[i].z() < -0.8) dorsal = std::min(dorsal, depth);
    }
    EXPECT_GT(palmar, dorsal) << name;
  }
}

TEST_F(TemplateBones, StayInsideTheSkinOfAFist) {
  const auto fist = hand::named_posture(hand().skeleton, "fist");
  ASSERT_TRUE(fist);
  geometry::TriangleMesh posed = hand().skin;
  posed.vertices = hand::pose_skin(hand(), *fist);
  const std::vector<geometry::TriangleMesh> bones = hand::pose_bones(hand(), *fist);
  const geometry::MeshDistance skin(posed);
  for (std::size_t b = 0; b < bones.size(); ++b) {
    int outside = 0;
    for (const Vec3& v : bones[b].vertices) outside += skin.at(v).distance > 0.0;
    // Over a flexed knuckle the skin is thin; a rim of a base may break through the crease.
    EXPECT_LE(outside, bones[b].vertex_count() / 20) << hand().bones[b].name;
  }
}

}  // namespace
}  // namespace palmar::tests
