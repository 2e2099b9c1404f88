// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parametric_kinds.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "palmar/core/error.h"

namespace palmar::product {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Given = std::vector<std::pair<std::string, double>>;

std::string refusal(const std::string& kind, const Given& given) {
  try {
    complete_values(parametric_kind(kind), given);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(ParametricKinds, DefaultsHoldAllRelations) {
  for (const ParametricKind& kind : parametric_kinds()) {
    EXPECT_EQ(refusal(kind.name, {}), "");
    EXPECT_EQ(complete_values(kind, {}).size(), kind.parameters.size());
  }
}

TEST(ParametricKinds, DefaultsLieInsideTheirRangesAndNamesAreUnique) {
  for (const ParametricKind& kind : parametric_kinds()) {
    std::set<std::string> names;
    for (const KindParameter& one : kind.parameters) {
      EXPECT_TRUE(names.insert(one.name).second) << kind.name << " " << one.name;
      EXPECT_LE(one.lowest, one.fallback) << kind.name << " " << one.name;
      EXPECT_GE(one.highest, one.fallback) << kind.name << " " << one.name;
    }
    for (const KindRelation& one : kind.relations) {
      EXPECT_EQ(names.count(one.parameter), 1U) << kind.name << " " << one.parameter;
    }
  }
}

// The centre line of the grip goes from its foot, which lies behind (+y), up to the frame.
TEST(ParametricKinds, ThePistolGripReportsThatTheThumbIsAtItsFrame) {
  const ParametricKind& kind = parametric_kind("pistol_grip");
  const Vec3 side = kind.thumb_side(complete_values(kind, {{"rake_deg", 30.0}}));
  EXPECT_LT((side - Vec3(0.0, -0.5, std::sqrt(0.75))).norm(), 1e-12);
  EXPECT_FALSE(parametric_kind("bottle").thumb_side);
}

TEST(ParametricKinds, GivenValuesTakeTheDefaultsPlace) {
  const KindValues values = complete_values(parametric_kind("bottle"), {{"diameter_mm", 70.0}});
  EXPECT_EQ(values.at("diameter_mm"), 70.0);
  EXPECT_EQ(values.at("height_mm"), 220.0);
}

TEST(ParametricKinds, MessagesNameKindParameterValueAndRange) {
  EXPECT_EQ(refusal("bottle", {{"diameter_mm", 500.0}}),
            "bottle: diameter_mm is 500 mm; 20 to 200 mm is allowed");
  EXPECT_EQ(refusal("tapered_handle", {{"taper_deg", -1.0}}),
            "tapered_handle: taper_deg is -1 deg; 0 to 30 deg is allowed");
  EXPECT_EQ(refusal("screwdriver_handle", {{"flutes", 5.5}}),
            "screwdriver_handle: flutes is 5.5; a whole number from 3 to 12 is allowed");
  EXPECT_EQ(refusal("prism", {{"fillet_mm", 16.0}}),
            "prism: fillet_mm is 16 mm; at most 15 mm is allowed (half of the smaller of width_mm "
            "and depth_mm)");
  EXPECT_THAT(refusal("prism", {{"filet_mm", 3.0}}),
              AllOf(HasSubstr("prism has no parameter \"filet_mm\""),
                    HasSubstr("did you mean fillet_mm?"), HasSubstr("width_mm, depth_mm")));
  EXPECT_EQ(refusal("prism", {{"fillet_mm", 3.0}, {"fillet_mm", 4.0}}),
            "prism: fillet_mm is given twice");
  EXPECT_THAT(refusal("prisn", {}),
              AllOf(HasSubstr("kind \"prisn\" isn't known"), HasSubstr("did you mean prism?"),
                    HasSubstr("bicycle_grip")));
}

TEST(ParametricKinds, ABoundMayBeReached) {
  EXPECT_EQ(refusal("prism", {{"fillet_mm", 15.0}}), "");
  EXPECT_EQ(refusal("phone", {{"thickness_mm", 8.0}, {"fillet_mm", 3.92}}), "");  // 0.49 of 8
}

}  // namespace
}  // namespace palmar::product
