// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "palmar/geometry/remesh/remesh.h"
#include "palmar/geometry/remesh/subdivide.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/dimensions/tape_measures.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/posture/skeleton_in_posture.h"
#include "palmar/hand/skin/creases.h"
#include "palmar/hand/skin/skinning.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

class TemplateDimensions : public TemplateTest {};

const hand::SegmentDimensions& of(const hand::HandDimensions& d, hand::Segment s) {
  return d.segment[static_cast<std::size_t>(s)];
}

TEST_F(TemplateDimensions, AreThoseOfAnAdult) {
  // Within three standard deviations of men or women of ANSUR II (hand length 193.3 +- 10.0 and
  // 181.1 +- 10.1, circumference 212.3 +- 10.2 and 186.6 +- 8.8, breadth 88.3 +- 4.4 and
  // 78.2 +- 3.8 mm) and of palm thickness 24 to 33 mm (NASA RP-1024; derived from ANSUR II).
  const hand::HandDimensions d = hand::measure_hand(hand());
  EXPECT_GT(d.hand_length, 181.1 - 3 * 10.1);
  EXPECT_LT(d.hand_length, 193.3 + 3 * 10.0);
  EXPECT_GT(d.hand_circumference, 186.6 - 3 * 8.8);
  EXPECT_LT(d.hand_circumference, 212.3 + 3 * 10.2);
  EXPECT_GT(d.hand_width, 78.2 - 3 * 3.8);
  EXPECT_LT(d.hand_width, 88.3 + 3 * 4.4);
  EXPECT_GT(d.hand_thickness, 24.0);
  EXPECT_LT(d.hand_thickness, 34.0);
}

TEST_F(TemplateDimensions, CircumferenceLiesBetweenItsOwnEllipseAndRectangle) {
  const hand::HandDimensions d = hand::measure_hand(hand());
  // A convex curve of breadth W and thickness T; T at head III may fall short of the greatest.
  EXPECT_GT(d.hand_circumference, 2.0 * std::hypot(d.hand_width, d.hand_thickness));
  EXPECT_LT(d.hand_circumference, 2.0 * (d.hand_width + 1.2 * d.hand_thickness));
}

TEST_F(TemplateDimensions, SegmentsAddUpToTheMiddleFinger) {
  const hand::HandDimensions d = hand::measure_hand(hand());
  const double sum =
      of(d, hand::Segment::kPalm).length + of(d, hand::Segment::kMiddleProximal).length +
      of(d, hand::Segment::kMiddleMiddle).length + of(d, hand::Segment::kMiddleDistal).length;
  // The finger leans in the palm and bends a little, so the parts exceed the whole by a few mm.
  EXPECT_NEAR(sum, d.hand_length, 0.03 * d.hand_length);
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const hand::SegmentDimensions& part = d.segment[static_cast<std::size_t>(s)];
    EXPECT_GT(part.length, 8.0) << name_of(static_cast<hand::Segment>(s));
    EXPECT_GT(part.width, 8.0) << name_of(static_cast<hand::Segment>(s));
    EXPECT_GT(part.thickness, 8.0) << name_of(static_cast<hand::Segment>(s));
  }
}

TEST_F(TemplateDimensions, GrowWithTheHand) {
  geometry::TriangleMesh skin = hand().skin;
  hand::Skeleton skeleton = hand().skeleton;
  const double factor = 1.1;
  for (Vec3& v : skin.vertices) v *= factor;
  for (hand::Joint& joint : skeleton.joints) {
    joint.centre *= factor;
    for (hand::JointDof& dof : joint.dofs) dof.centre *= factor;
  }
  for (Vec3& tip : skeleton.fingertips) tip *= factor;
  const hand::HandDimensions small = hand::measure_hand(hand());
  const hand::HandDimensions large = hand::measure_hand(skin, skeleton);
  EXPECT_NEAR(large.hand_length, factor * small.hand_length, 1e-6);
  EXPECT_NEAR(large.hand_circumference, factor * small.hand_circumference, 1e-6);
  for (std::size_t s = 0; s < hand::kSegmentCount; ++s) {
    // The crease's margin over the web (1.5 mm) does not scale.
    EXPECT_NEAR(large.segment[s].length, factor * small.segment[s].length, 0.2);
    EXPECT_NEAR(large.segment[s].width, factor * small.segment[s].width, 0.1);
  }
}

TEST_F(TemplateDimensions, AreTheSameOnALeftHand) {
  const hand::Hand left = hand::mirrored(hand());
  const hand::HandDimensions a = hand::measure_hand(hand()), b = hand::measure_hand(left);
  EXPECT_NEAR(a.hand_length, b.hand_length, 1e-9);
  EXPECT_NEAR(a.hand_circumference, b.hand_circumference, 1e-9);
  EXPECT_NEAR(a.hand_thickness, b.hand_thickness, 1e-9);
  for (std::size_t s = 0; s < hand::kSegmentCount; ++s) {
    EXPECT_NEAR(a.segment[s].length, b.segment[s].length, 1e-9);
    EXPECT_NEAR(a.segment[s].thickness, b.segment[s].thickness, 1e-9);
  }
}

TEST_F(TemplateDimensions, HardlyDependOnTheMesh) {
  // The same surface cut into smaller triangles, and these thinned out again: corners stay on it.
  const geometry::TriangleMesh fine = geometry::subdivide(
      hand().skin, {.scheme = geometry::SubdivisionScheme::kFittedLoop, .fit_rounds = 4});
  const geometry::TriangleMesh again = geometry::remesh(fine, {.edge_length = 1.8}).mesh;
  const hand::HandDimensions a = hand::measure_hand(fine, hand().skeleton);
  const hand::HandDimensions b = hand::measure_hand(again, hand().skeleton);
  EXPECT_NEAR(a.hand_length, b.hand_length, 0.05);  // mm
  EXPECT_NEAR(a.hand_width, b.hand_width, 0.1);
  EXPECT_NEAR(a.hand_thickness, b.hand_thickness, 0.1);
  EXPECT_NEAR(a.hand_circumference, b.hand_circumference, 0.3);
  for (std::size_t s = 0; s < hand::kSegmentCount; ++s) {
    // Lengths follow the webs, whose ridge a coarser mesh cuts.
    EXPECT_NEAR(a.segment[s].length, b.segment[s].length, 0.25);
    EXPECT_NEAR(a.segment[s].width, b.segment[s].width, 0.15);
    EXPECT_NEAR(a.segment[s].thickness, b.segment[s].thickness, 0.15);
  }
}

/// The same surface, its triangles cut into four.
geometry::TriangleMesh quartered(const geometry::TriangleMesh& mesh) {
  geometry::TriangleMesh fine{mesh.vertices, {}};
  std::map<std::pair<int, int>, int> middle;
  const auto between = [&](int a, int b) {
    const auto [place, is_new] = middle.try_emplace(std::minmax(a, b), fine.vertex_count());
    if (is_new) {
      fine.vertices.push_back(0.5 * (mesh.vertices[static_cast<std::size_t>(a)] +
                                     mesh.vertices[static_cast<std::size_t>(b)]));
    }
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const int ab = between(a, b), bc = between(b, c), ca = between(c, a);
    fine.triangles.insert(fine.triangles.end(),
                          {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

/// Index, middle and ring finger curled, the little one spread.
hand::Posture curled(double curl_deg, double spread_deg) {
  const double radians_per_degree = std::numbers::pi / 180.0;
  hand::Posture posture;
  for (const hand::Dof dof :
       {hand::Dof::kIndexMcpFlexion, hand::Dof::kIndexPipFlexion, hand::Dof::kMiddleMcpFlexion,
        hand::Dof::kMiddlePipFlexion, hand::Dof::kRingMcpFlexion, hand::Dof::kRingPipFlexion}) {
    posture[dof] = curl_deg * radians_per_degree;
  }
  posture[hand::Dof::kLittleMcpAbduction] = spread_deg * radians_per_degree;
  return posture;
}

TEST_F(TemplateDimensions, WebsStayInPlaceWhereOtherFingersReachFarther) {
  // A web is where the same skin was in the reference posture, give or take what the palm folds.
  const hand::HandCreases reference(hand().skin, hand().skeleton);
  std::array<std::size_t, 4> vertex{};
  for (int k = 0; k < 4; ++k) {
    const auto& all = hand().skin.vertices;
    const auto nearest =
        std::min_element(all.begin(), all.end(), [&](const Vec3& a, const Vec3& b) {
          return (a - reference.web(k)).norm() < (b - reference.web(k)).norm();
        });
    vertex[k] = static_cast<std::size_t>(nearest - all.begin());
  }
  for (const double curl : {0.0, 20.0, 40.0, 60.0}) {
    for (const double spread : {-25.0, 0.0, 25.0}) {
      const hand::Posture posture = curled(curl, spread);
      geometry::TriangleMesh skin = hand().skin;
      skin.vertices = hand::pose_skin(hand(), posture);
      const hand::HandCreases creases(skin, hand::skeleton_in_posture(hand().skeleton, posture));
      for (const int k : {0, 1, 2, 3}) {
        EXPECT_LT((creases.web(k) - skin.vertices[vertex[k]]).norm(), k == 0 ? 15.0 : 12.0)
            << "web " << k << ", curl " << curl << ", spread " << spread << " deg";
      }
    }
  }
}

TEST_F(TemplateDimensions, TapeIsNoShorterThanTheStraightLine) {
  const hand::HandDimensions d = hand::measure_hand(hand());
  const hand::HandCreases creases(hand().skin, hand().skeleton);
  const hand::HandTape tape = hand::measure_with_tape(hand().skin, hand().skeleton, creases);
  EXPECT_GE(tape.palmar_hand_length().value(), d.hand_length);
  EXPECT_GE(tape.dorsal_hand_length().value(), d.hand_length);
  EXPECT_LT(tape.dorsal_hand_length().value(), 1.15 * d.hand_length);
  for (int k = 0; k < hand::kSegmentCount; ++k) {
    const auto segment = static_cast<hand::Segment>(k);
    const hand::SegmentDimensions& s = of(d, segment);
    const hand::SegmentTape& t = tape.segment[static_cast<std::size_t>(k)];
    // Both are held on the sides; the girth spans what is hollow there.
    EXPECT_NEAR(t.palmar_width + t.dorsal_width, t.girth, 0.01 * t.girth) << name_of(segment);
    EXPECT_GE(t.palmar_width, s.width) << name_of(segment);
    EXPECT_GE(t.dorsal_width, s.width) << name_of(segment);
    EXPECT_GE(t.palmar_length.value(), s.length - 1e-9) << name_of(segment);
    // A convex curve is longer than twice its diagonal, and shorter than its rectangle.
    EXPECT_GT(t.girth, 2.0 * std::hypot(s.width, s.thickness)) << name_of(segment);
    EXPECT_GT(t.dorsal_length.value(), 8.0) << name_of(segment);
  }
  EXPECT_DOUBLE_EQ(tape.segment[0].girth, d.hand_circumference);
}

TEST_F(TemplateDimensions, TapeIsTheSameOnALeftHandAndAnotherMesh) {
  const hand::HandCreases creases(hand().skin, hand().skeleton);
  const auto values =
      hand::values_of(hand::measure_with_tape(hand().skin, hand().skeleton, creases));
  const hand::Hand left = hand::mirrored(hand());
  const auto other = hand::values_of(hand::measure_with_tape(
      left.skin, left.skeleton, hand::HandCreases(left.skin, left.skeleton)));
  const auto fine =
      hand::values_of(hand::measure_with_tape(quartered(hand().skin), hand().skeleton, creases));
  for (std::size_t k = 0; k < values.size(); ++k) {
    EXPECT_NEAR(values[k].value, other[k].value, 1e-6) << values[k].quantity;
    EXPECT_NEAR(values[k].value, fine[k].value, 0.05) << values[k].quantity;  // mm
  }
}

}  // namespace
}  // namespace palmar::tests
