// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/parameter_sweep.h"

#include <gmock/gmock.h>

#include "palmar/core/error.h"

namespace palmar::records {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <typename Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ParameterSweep, GoesFromToByStepsWithBothEnds) {
  EXPECT_THAT(parse_sweep("diameter_mm", "25:35:2.5"), ElementsAre(25, 27.5, 30, 32.5, 35));
  EXPECT_THAT(parse_sweep("diameter_mm", "25:34:5"), ElementsAre(25, 30));
  EXPECT_THAT(parse_sweep("diameter_mm", "25:25:5"), ElementsAre(25));
  EXPECT_THAT(parse_sweep("diameter_mm", "35"), ElementsAre(35));
  EXPECT_THAT(parse_sweep("diameter_mm", "30,45,35"), ElementsAre(30, 45, 35));
  // As people would call them, not 25.299999999999997.
  EXPECT_THAT(parse_sweep("diameter_mm", "25:25.3:0.1"), ElementsAre(25, 25.1, 25.2, 25.3));
}

TEST(ParameterSweep, MessagesSayWhatIsAllowed) {
  const auto said = [](const std::string& text) {
    return refusal([&] { parse_sweep("diameter_mm", text); });
  };
  EXPECT_EQ(said("25:60:0"), "diameter_mm: the sweep's step is 0 mm; above 0 is allowed");
  EXPECT_THAT(said("60:25:5"), HasSubstr("the sweep goes from 60 mm down to 25 mm"));
  EXPECT_EQ(said("0:10:0.001"), "diameter_mm makes 10001 variants; up to 1000 are allowed");
  for (const char* bad : {"25:60", "25:60:5:1", "a", "", "30,", "inf", "1:nan:1"}) {
    EXPECT_THAT(said(bad), HasSubstr("from:to:step (25:60:2.5) or a list (30,35,45)")) << bad;
  }
  EXPECT_THAT(said("30,30"), HasSubstr("twice"));
}

TEST(ParameterSweep, SeveralSweepsMakeAGrid) {
  const std::vector<MadeVariant> variants =
      variants_of({"tapered_handle", {{"diameter_mm", {30, 40}}, {"taper_deg", {1, 2, 3}}}});
  ASSERT_EQ(variants.size(), 6U);
  EXPECT_EQ(variants[1].suffix, "diameter 30 mm taper 2 deg");
  EXPECT_EQ(words_of(variants[5].product), "made: tapered_handle diameter_mm=40 taper_deg=3");
}

TEST(ParameterSweep, OneVariantThatCannotBeIsNamed) {
  EXPECT_EQ(refusal([] {
              variants_of({"prism", {{"fillet_mm", {5, 15, 20}}}});
            }),
            "prism: fillet_mm is 20 mm; at most 15 mm is allowed (half of the smaller of width_mm "
            "and depth_mm)");
  EXPECT_THAT(refusal([] {
                variants_of({"cylinder",
                             {{"diameter_mm", std::vector<double>(100, 30.0)},
                              {"length_mm", std::vector<double>(100, 90.0)}}});
              }),
              HasSubstr("cylinder makes 10000 variants; up to 1000 are allowed"));
}

TEST(MadeProduct, WordsAreReadBack) {
  const MadeProduct made = made_from("made: bottle diameter_mm=66 waist_depth_mm=0");
  EXPECT_EQ(words_of(made), "made: bottle diameter_mm=66 waist_depth_mm=0");
  EXPECT_EQ(title_of(made), "bottle diameter 66 mm waist depth 0 mm");
  EXPECT_FALSE(is_analytic(made));
  EXPECT_TRUE(is_analytic(made_from("made: prism fillet_mm=3")));
  EXPECT_FALSE(is_analytic(made_from("made: prism fillet_mm=3 end_fillet_mm=2")));
}

TEST(MadeProduct, WordsThatDetermineNothingAreRefused) {
  EXPECT_THAT(refusal([] { made_from("made: "); }), HasSubstr("describes no product"));
  EXPECT_THAT(refusal([] { made_from("made: bottle wide"); }),
              HasSubstr("\"wide\" is no parameter with its value, as diameter_mm=35 is"));
  EXPECT_THAT(refusal([] { made_from("made: botle"); }), HasSubstr("did you mean bottle?"));
  EXPECT_THAT(refusal([] { made_from("made: bottle diameter_mm=1e9"); }),
              HasSubstr("20 to 200 mm is allowed"));
}

TEST(MadeProduct, AnAnalyticSolidTakesItsSize) {
  const product::Product product =
      make_solid(made_from("made: cylinder diameter_mm=40"), {.size = 0.5});
  EXPECT_NEAR(product.mesh.vertices.front().z(), -37.5, 1e-9);  // half of 150 mm long
  EXPECT_EQ(product.source, "made: cylinder diameter_mm=40");
}

}  // namespace
}  // namespace palmar::records
