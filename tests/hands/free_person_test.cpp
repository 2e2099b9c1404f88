// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Synthetic persons that aren't the template's near relatives: as far from it as surveys have
// people, axes as dispersed as asked.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "hands/phantom/person/person_size.h"
#include "hands/phantom/person/subject_person.h"
#include "hands/phantom/photo/painted_hand.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/repair/self_intersection.h"
#include "palmar/hand/instance/hand_instance.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

class FreePerson : public TemplateTest {};

struct Sums {
  double n = 0.0, sum = 0.0, squares = 0.0;
  void add(double x) {
    n += 1.0;
    sum += x;
    squares += x * x;
  }
  double mean() const { return sum / n; }
  double deviation() const { return std::sqrt(squares / n - mean() * mean()); }
};

TEST_F(FreePerson, LengthsAreTheSurveysOwn) {
  // Residuals of palm and links over a survey's prediction, in its deviations, of 2 000 persons: 0
  // within 3 standard errors, and 1 but for what is held to 2.5 deviations (0.989).
  std::map<hand::Segment, Sums> sums;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    const phantom::PersonSize size = phantom::drawn_size(seed, phantom::kFreePerson);
    const population::AnsurFigures& ansur = population::ansur2_figures(size.sex);
    const population::GreinerFigures& greiner = population::greiner_figures(size.sex);
    for (const auto& [dimension, length] :
         phantom::surveyed_lengths(hand().dimensions, size, seed)) {
      const hand::Segment segment = dimension.segment;
      if (segment == hand::Segment::kPalm) {
        const double usual = ansur.palm.mean + ansur.palm_slope * (size.length - ansur.length.mean);
        sums[segment].add((length - usual) / ansur.palm_residual);
      } else if (segment == hand::Segment::kThumbDistal ||
                 segment == hand::Segment::kMiddleMiddle ||
                 segment == hand::Segment::kLittleDistal) {
        const population::Moment& link =
            segment == hand::Segment::kThumbDistal    ? greiner.thumb_distal
            : segment == hand::Segment::kMiddleMiddle ? greiner.link[1][1]
                                                      : greiner.link[3][2];
        const double usual = link.mean * size.length / greiner.length.mean;
        sums[segment].add((length / usual - 1.0) /
                          population::residual_share(link, greiner.length));
      }
    }
  }
  ASSERT_EQ(sums.size(), 4U);
  for (const auto& [segment, sum] : sums) {
    SCOPED_TRACE(name_of(segment));
    // Hands with segments out of proportion are drawn again: palms are shorter, links less spread.
    const bool is_whole = segment == hand::Segment::kThumbDistal;
    EXPECT_NEAR(sum.mean(), 0.0, is_whole ? 3.0 / std::sqrt(2000.0) : 0.5);
    EXPECT_NEAR(sum.deviation(), is_whole ? 0.98 : 0.75, is_whole ? 0.05 : 0.25);
  }
}

TEST_F(FreePerson, IsAsLongAndAsBroadAsWasDrawn) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    SCOPED_TRACE(seed);
    const phantom::PersonSize size = phantom::drawn_size(seed, phantom::kFreePerson);
    const hand::Hand person = phantom::sized_hand(hand(), seed, phantom::kFreePerson);
    EXPECT_NEAR(person.dimensions.hand_length, size.length, 0.2);        // mm
    EXPECT_NEAR(person.dimensions.hand_circumference, size.girth, 0.2);  // mm
  }
}

TEST_F(FreePerson, FingersAreAsBroadAsASurveys) {
  // Greiner 1991: breadth of index and middle finger at the PIP joint over circumference 0.108 and
  // 0.106 (men), 0.107 and 0.103 (women), 5 % about it; joints thicker than shafts add 3 %. The
  // start hand's are 0.087.
  Sums share;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const phantom::SubjectPerson person = phantom::make_person(hand(), seed, phantom::kFreePerson);
    const double girth = phantom::drawn_size(seed, phantom::kFreePerson).girth;
    share.add(0.5 * (person.finger_width[1] + person.finger_width[2]) / girth);
  }
  EXPECT_NEAR(share.mean(), 0.106, 0.08 * 0.106);
  EXPECT_LT(share.deviation() / share.mean(), 0.1);
}

TEST_F(FreePerson, AxesAreAsDispersedAsAsked) {
  // Two directions across the axis with a deviation of s each: s sqrt(pi / 2) in the mean, less 1 %
  // as both are held to 2.5 s.
  phantom::PersonDispersion straight, wide;
  straight.axis = straight.slant = 0.0;
  wide.axis = wide.slant = 0.09;
  Sums angle;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const phantom::SubjectPerson one = phantom::make_person(hand(), seed, straight);
    const phantom::SubjectPerson other = phantom::make_person(hand(), seed, wide);
    for (int k = 1; k < hand::kSegmentCount; ++k) {
      const double cosine = one.joints.phalanx[k].axis.dot(other.joints.phalanx[k].axis);
      angle.add(std::acos(std::min(1.0, cosine)));
    }
  }
  EXPECT_NEAR(angle.mean(), 0.99 * 0.09 * std::sqrt(0.5 * std::numbers::pi), 0.006);  // rad
}

TEST_F(FreePerson, SkinIsAHandsSkin) {
  const phantom::SubjectPerson person = phantom::make_person(hand(), 2, phantom::kFreePerson);
  EXPECT_NO_THROW(geometry::require_closed_manifold(person.skin, "skin"));
  EXPECT_LT(geometry::crossing_depth(person.skin).deepest, 1.0);  // mm
  EXPECT_EQ(person.skin.triangles, hand().skin.triangles);
  for (const std::uint64_t seed : {2011U, 2015U, 2016U}) {  // whose ends were lost
    SCOPED_TRACE(seed);
    const hand::Skeleton bones = phantom::make_person(hand(), seed, phantom::kFreePerson).skeleton;
    for (int f = 1; f < hand::kFingerCount; ++f) {
      const hand::Segment last = *hand::segments_of(static_cast<hand::Finger>(f))[2];
      EXPECT_GT((bones.fingertips[f] - bones.joint(hand::joint_of(last)).centre).norm(),
                13.0);  // mm
    }
  }
}

TEST_F(FreePerson, FingersMoveBetweenTakesAsFarAsAsked) {
  phantom::PaintedHandOptions options;
  options.levels = 0;
  options.takes = 13;
  options.restless = 1.5;
  const phantom::PaintedHand person =
      phantom::make_painted_hand(hand(), {hand::ScanPosture::kReference}, options);
  ASSERT_EQ(person.takes.size(), 12U);
  const std::vector<Vec3>& first = person.postures.at(hand::ScanPosture::kReference).skin;
  double sum = 0.0, count = 0.0;
  for (const auto& [segment, tip] : person.postures.at(hand::ScanPosture::kReference).fingertip) {
    for (const std::vector<Vec3>& skin : person.takes) {
      for (std::size_t v = 0; v < skin.size(); ++v) {
        if ((first[v] - tip).norm() > 1e-9) continue;
        sum += (skin[v] - first[v]).squaredNorm();
        count += 1.0;
      }
    }
  }
  ASSERT_EQ(count, 60.0);
  // 120 normal deviates: a deviation of 6.5 % of the root; three of them.
  EXPECT_NEAR(std::sqrt(sum / count), 1.5, 0.2 * 1.5);  // mm
  // The palm stays where it is.
  double palm = 0.0;
  for (std::size_t v = 0; v < first.size(); ++v) {
    if (std::abs(first[v].y() - 10.0) < 5.0)
      palm = std::max(palm, (person.takes[0][v] - first[v]).norm());
  }
  EXPECT_LT(palm, 0.5);  // mm
}

}  // namespace
}  // namespace palmar::tests
