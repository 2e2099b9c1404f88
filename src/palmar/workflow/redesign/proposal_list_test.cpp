// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/proposal_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "palmar/product/primitives.h"
#include "palmar/workflow/redesign/feature_proposals.h"

namespace palmar::workflow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

product::ProductFaces prism(double fillet) {
  product::PrismProductOptions options;
  options.fillet_radius = fillet;
  return *product::make_prism_product(options).faces;
}

study::FaceSummary touched(const product::ProductFaces& faces, const std::string& name,
                           double share, double peaks) {
  study::FaceSummary summary;
  for (std::size_t f = 0; f < faces.face.size(); ++f) {
    if (faces.face[f].name == name) summary.face = static_cast<int>(f);
  }
  summary.touched.share = share;
  summary.has_peak.share = peaks;
  summary.has_peak.count = static_cast<int>(100 * peaks);
  return summary;
}

std::string number_of(const product::ProductFaces& faces, const std::string& name) {
  for (const product::ProductFace& face : faces.face) {
    if (face.name == name) return std::to_string(face.number);
  }
  return "?";
}

std::vector<std::string> words_of(const std::vector<Proposal>& proposals) {
  std::vector<std::string> words;
  for (const Proposal& one : proposals) words.push_back(one.words);
  return words;
}

TEST(Proposals, EnlargeFilletsThatAreTouchedToo) {
  const product::ProductFaces faces = prism(3.0);
  const std::vector<Proposal> all =
      proposals_for(faces,
                    {touched(faces, "fillet 1", 0.9, 0.6), touched(faces, "fillet 2", 0.8, 0.0),
                     touched(faces, "right", 1.0, 0.4), touched(faces, "bottom", 0.05, 0.0)},
                    {});
  const std::string one = number_of(faces, "fillet 1"), two = number_of(faces, "fillet 2");
  const auto words = words_of(all);
  EXPECT_THAT(words, Contains("fillet:face=" + one + "+" + two + "=6"));
  EXPECT_THAT(words, Contains("fillet:face=" + one + "+" + two + "=12"));
  EXPECT_THAT(words, Contains("fillet:face=" + one + "=6"));
  EXPECT_THAT(words, Not(Contains("fillet:face=" + two + "=6")));  // carries no peak by itself
  EXPECT_THAT(words, Contains("offset:face=" + number_of(faces, "right") + "=1"));
  EXPECT_THAT(words, Not(Contains(HasSubstr("offset:face=" + number_of(faces, "bottom") + "="))));
}

TEST(Proposals, KeepToTheBudgetOfChange) {
  const product::ProductFaces faces = prism(3.0);
  FeatureLimits limits;
  limits.largest_offset = 1.0;
  // A fillet at 90 degrees moves by (sqrt 2 - 1) of the change of its radius: 3 + 2.41 mm.
  const auto words = words_of(proposals_for(faces, {touched(faces, "fillet 1", 0.9, 0.6)}, limits));
  EXPECT_THAT(words, Contains("fillet:face=" + number_of(faces, "fillet 1") + "=5.4"));
  for (const std::string& one : words) {
    EXPECT_LE(std::stod(one.substr(one.rfind('=') + 1)), 3.0 + 1.0 / (std::sqrt(2.0) - 1.0)) << one;
  }
}

TEST(Proposals, OfASharpPrismAreItsEdges) {
  const product::ProductFaces faces = prism(0.0);
  const auto words = words_of(proposals_for(faces, {touched(faces, "right", 0.9, 0.6)}, {}));
  EXPECT_THAT(words, Contains(::testing::ContainsRegex("fillet:edge=[0-9+]+=3")));
  EXPECT_THAT(words, Contains(::testing::ContainsRegex("fillet:edge=[0-9+]+=6")));
}

TEST(Proposals, ThatNobodyTouchesAreNone) {
  const product::ProductFaces faces = prism(3.0);
  EXPECT_TRUE(proposals_for(faces, {}, {}).empty());
  EXPECT_TRUE(proposals_for(faces, {touched(faces, "right", 0.05, 0.0)}, {}).empty());
}

TEST(Proposals, AreWorthAChangeOnlyBeyondChance) {
  EXPECT_EQ(verdict_on(0.05, 0.01), ProposalVerdict::kChange);
  EXPECT_EQ(verdict_on(0.05, 0.03), ProposalVerdict::kLeave);
  EXPECT_EQ(verdict_on(-0.01, 0.03), ProposalVerdict::kLeave);
  EXPECT_EQ(verdict_on(-0.05, 0.01), ProposalVerdict::kWorse);
  EXPECT_EQ(verdict_on(0.0, 0.0), ProposalVerdict::kLeave);
}

}  // namespace
}  // namespace palmar::workflow
