// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/words/verdict_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace palmar::report {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

grasp::ComfortResult comfort_with(double peak, double share_without_blood) {
  grasp::ComfortResult comfort;
  comfort.regions.resize(2);
  comfort.pain = grasp::WorstRegion{hand::Region::kRingDistal, peak, 0.496, peak > 0.496 ? 1 : 0};
  comfort.discomfort =
      grasp::WorstRegion{hand::Region::kRingDistal, peak, 0.188, peak > 0.188 ? 1 : 0};
  comfort.sustained_share = share_without_blood;
  return comfort;
}

TEST(ComfortWords, AnswerThreeQuestionsInOneSentence) {
  const Texts texts(Language::kEnglish);
  EXPECT_EQ(comfort_words(comfort_with(0.2, 0.62), texts),
            "a moment of this grip doesn’t hurt; repeated, it becomes uncomfortable in one of 2 "
            "regions, most at the tip of the ring finger; held for minutes without a break, it "
            "stops the blood in 62 % of the touched skin.");
  EXPECT_EQ(comfort_words(comfort_with(0.02, 0.0), texts),
            "a moment of this grip doesn’t hurt; repeated, it stays comfortable; held for minutes, "
            "blood still flows in the skin.");
  EXPECT_THAT(comfort_words(comfort_with(0.6, 0.9), texts),
              HasSubstr("hurts, first at the tip of the ring finger; repeated, it becomes"));
  EXPECT_THAT(comfort_words({}, texts), HasSubstr("isn’t in the hand"));
}

TEST(ComfortWords, SpeakGerman) {
  const std::string words = comfort_words(comfort_with(0.2, 0.62), Texts(Language::kGerman));
  EXPECT_THAT(words, HasSubstr("an der Kuppe des Ringfingers"));
  EXPECT_THAT(words, Not(HasSubstr("grip")));
}

study::AssessedProduct held(const std::string& name, double grip_force, double peak) {
  study::AssessedProduct one;
  one.product.name = name;
  one.product.source = name + ".stl";
  one.product.unit_source = product::UnitSource::kUser;
  study::Assessment& assessment = one.assessment;
  assessment.grasp.status = grasp::GraspStatus::kHeld;
  assessment.balance.status = grasp::BalanceStatus::kBalanced;
  assessment.balance.grip_force = grip_force;
  for (const hand::Region region :
       {hand::Region::kThumbDistal, hand::Region::kIndexDistal, hand::Region::kMiddleDistal}) {
    contact::RegionContact contact;
    contact.region = region;
    contact.peak_pressure_cells = peak;
    assessment.contact.regions.push_back(contact);
  }
  assessment.contact.total.peak_pressure_cells = peak;
  assessment.contact.total.area = 1000.0;
  return one;
}

records::VerdictWords words_of(std::vector<study::AssessedProduct> products,
                               const std::string& line = "") {
  const study::AssessmentSet set{.hand = std::make_shared<hand::Hand>(),
                                 .assessments = std::move(products),
                                 .command_line = line};
  return verdict_words(set, study::verdict_of(set), Language::kEnglish);
}

TEST(VerdictWords, AnotherHoldIsAReasonToDoubtADifference) {
  std::vector<study::AssessedProduct> two = {held("A", 60, 0.40), held("B", 60, 0.292)};
  EXPECT_THAT(words_of(two).reasons, Not(Contains(HasSubstr("lies otherwise"))));
  two[1].assessment.grasp.product_from_hand.rotation =
      Quat(Eigen::AngleAxisd(std::numbers::pi / 6.0, Vec3::UnitX()));
  two[1].assessment.grasp.grip_point = Vec3(0.0, 12.0, 0.0);
  EXPECT_THAT(words_of(two).reasons,
              Contains("The hand lies otherwise on B than on A: turned by 30° and shifted by 12 mm "
                       "in the frame of their files. Part of the difference may be that of the "
                       "hold."));
}

TEST(VerdictWords, TheAnswerNamesProductsAmountAndForce) {
  const records::VerdictWords words = words_of({held("A", 60, 0.40), held("B", 60, 0.292)});
  EXPECT_EQ(words.sentence,
            "B presses 27 % less than A at its hardest place, in the same grip of 60 N; its "
            "contact area is about the same.");
  EXPECT_EQ(words.command,
            "palmar study run --product A.stl --product B.stl --unit mm --hands 12 --out "
            "hands.palmar");
}

TEST(VerdictWords, TheNextCommandAsksForTheSameTask) {
  const records::VerdictWords words =
      words_of({held("A", 60, 0.40), held("B", 60, 0.292)},
               "palmar assess A.stl B.stl --unit mm --grip-force-n 60 --left --mass-kg=0.4");
  EXPECT_EQ(words.command,
            "palmar study run --product A.stl --product B.stl --unit mm --grip-force-n 60 "
            "--mass-kg=0.4 --hands 12 --out hands.palmar");
}

TEST(VerdictWords, TheNextCommandKeepsTheTask) {
  EXPECT_EQ(words_of({held("A", 60, 0.40), held("B", 60, 0.292)},
                     "palmar assess A.stl B.stl --unit mm --task carry --mass-kg 2")
                .command,
            "palmar study run --product A.stl --product B.stl --unit mm --task carry --mass-kg 2 "
            "--hands 12 --out hands.palmar");
}

TEST(VerdictWords, WhatHoldsItsOwnLoadIsComparedAtThatTask) {
  std::vector<study::AssessedProduct> products = {held("A", 28, 0.40), held("B", 14, 0.292)};
  const auto carries = [](study::Assessment& one, double weight) {
    one.options.balance.grip_force.reset();
    one.options.balance.share_of_strength.reset();
    one.options.balance.holds_load = true;
    one.options.balance.friction = 0.5;
    one.options.balance.load.weight = weight;
  };
  carries(products[0].assessment, 20.0);
  carries(products[1].assessment, 10.0);
  EXPECT_EQ(words_of(products).sentence,
            "B presses 27 % less than A at its hardest place, each gripped as its task asks (B "
            "with 14 N, A with 28 N); its contact area is about the same.");
  // A hand that doesn't give what the load asks for does another task.
  carries(products[0].assessment, 40.0);
  EXPECT_THAT(words_of(products).sentence, HasSubstr("No verdict yet"));
}

TEST(VerdictWords, AHardestPlaceOnAnUnresolvedEdgeIsTold) {
  std::vector<study::AssessedProduct> products = {held("A", 60, 0.40), held("B", 60, 0.292)};
  for (contact::RegionContact& region : products[0].assessment.contact.regions) {
    region.force = 10.0;
    region.unresolved_force = 5.0;
  }
  EXPECT_THAT(words_of(products).reasons,
              Contains("The hardest place of A is on edges sharper than the mesh of the skin: its "
                       "pressure may be off by 40 %, and so may this difference."));
  for (contact::RegionContact& region : products[0].assessment.contact.regions) {
    region.unresolved_force = 1.0;
  }
  EXPECT_THAT(words_of(products).reasons, Not(Contains(HasSubstr("edges sharper"))));
}

TEST(VerdictWords, NoDifferenceSaysWhy) {
  EXPECT_THAT(words_of({held("A", 60, 0.40), held("B", 60, 0.39)}).sentence,
              HasSubstr("No difference that matters: in the same grip of 60 N"));
  const records::VerdictWords unequal =
      words_of({held("A", 107, 0.40), held("B", 86.2, 0.3)},
               "palmar assess A.stl B.stl --unit mm --strength-share 0.3 --person male,30 --out x");
  EXPECT_EQ(unequal.sentence,
            "No verdict yet: A is held with 107 N and B with 86 N, and pressures can be compared "
            "in equally firm grips only.");
  EXPECT_EQ(unequal.command, "palmar assess A.stl B.stl --unit mm --out x --grip-force-n 81");
}

TEST(VerdictWords, WhatIsNotHeldSaysWhy) {
  std::vector<study::AssessedProduct> two = {held("A", 60, 0.40), held("B", 60, 0.2)};
  two[1].assessment.balance.status = grasp::BalanceStatus::kSlipsOut;
  EXPECT_EQ(words_of(two).sentence, "A is held firmly; B is not: it slips out of the hand.");
}

TEST(VerdictWords, OfThreeTheBestIsNamedOrNone) {
  EXPECT_THAT(words_of({held("A", 60, 0.4), held("B", 60, 0.2), held("C", 60, 0.3)}).sentence,
              HasSubstr("Of 3 products B presses least: 50 % less than A and 33 % less than C"));
  EXPECT_THAT(words_of({held("A", 60, 0.4), held("B", 60, 0.2), held("C", 60, 0.201)}).sentence,
              HasSubstr("No product is clearly the best. No difference that matters"));
}

TEST(VerdictWords, OneProductIsJudgedByItself) {
  const records::VerdictWords words = words_of({held("A", 60, 0.3)});
  EXPECT_THAT(words.sentence, HasSubstr("A is held with 60 N: a moment of this grip comes near"));
  EXPECT_EQ(words.command, "palmar redesign press A.stl --unit mm --hands 12 --out pressed");
  EXPECT_EQ(words_of({held("A", 60, 0.01)}).command,
            "palmar study run --product A.stl --unit mm --hands 12 --out hands.palmar");
}

TEST(ChangedCommand, KeepsWhatIsQuoted) {
  EXPECT_EQ(changed_command("palmar assess 'a b.stl' --limit-depths --out x", {"--limit-depths"},
                            "--grip-force-n 5"),
            "palmar assess 'a b.stl' --out x --grip-force-n 5");
  EXPECT_EQ(changed_command("palmar assess a --grip-force-n=9", {"--grip-force-n"}, ""),
            "palmar assess a");
}

}  // namespace
}  // namespace palmar::report
