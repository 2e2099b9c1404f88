// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/shape_use.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/workflow/redesign/search_story.h"

namespace palmar::workflow {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

RedesignRequest usual() {
  RedesignRequest request;
  request.product = "handle.step";
  request.grip_force = 60.0;
  return request;
}

TEST(ShapeUse, WhatIsNotSaidIsAsUsual) {
  const ShapeUseRequest use = shape_use("hand=left weight=0.25", usual());
  EXPECT_EQ(use.weight, 0.25);
  EXPECT_TRUE(use.asked.is_left);
  EXPECT_EQ(use.asked.grip_force, 60.0);
  EXPECT_EQ(use.asked.populations, usual().populations);
  const ShapeUseRequest other = shape_use(
      "grip-force-n=20  population=ansur2_women population=ansur2_men grip=medium_wrap hands=7",
      usual());
  EXPECT_EQ(other.weight, 1.0);
  EXPECT_EQ(other.asked.grip_force, 20.0);
  EXPECT_THAT(other.asked.populations, ElementsAre("ansur2_women", "ansur2_men"));
  EXPECT_EQ(other.asked.hands, 7);
  ASSERT_EQ(other.asked.grips.size(), 1U);
  EXPECT_EQ(other.asked.grips.front(), grasp::Grip::kMediumWrap);
}

TEST(ShapeUse, WhatIsNotUnderstoodIsNamed) {
  const auto refused = [](const std::string& words, const std::string& message) {
    EXPECT_THAT([&] { shape_use(words, usual()); }, ThrowsMessage<UsageError>(HasSubstr(message)))
        << words;
  };
  refused("weight=0", "weight is \"0\"; 0.001 to 1000 is allowed");
  refused("weight=x", "weight is \"x\"");
  refused("hand=both", "\"hand=both\" is not known");
  refused("force=30", "grip-force-n=");
  refused("grip=medium_wrp", "medium_wrap");
  refused("population=", "\"population=\" is not known");
}

ShapeUse use_of(double weight, double original, std::size_t first) {
  ShapeUse use{
      .name = "use", .weight = weight, .request = {}, .original = {.study = {}, .records = {}}};
  use.figure.value = original;
  use.first_values = first;
  return use;
}

TEST(FigureOfUses, OfOneUseIsItsFigure) {
  std::vector<ShapeUse> uses;
  uses.push_back(use_of(1.0, 4.0, 1));
  const redesign::GoalFigure one{
      .value = 3.0, .error = 0.5, .hands = 2, .lost = 1, .values = {2.0, 4.0}};
  const redesign::GoalFigure all = figure_of_uses(uses, {one});
  EXPECT_EQ(all.value, 3.0);
  EXPECT_EQ(all.values, one.values);
}

TEST(FigureOfUses, OfSeveralIsTheMeanOfTheSharesByTheirWeights) {
  std::vector<ShapeUse> uses;
  uses.push_back(use_of(0.75, 4.0, 1));
  uses.push_back(use_of(0.25, 0.5, 1));
  const redesign::GoalFigure firm{
      .value = 3.0, .error = 0.4, .hands = 2, .lost = 0, .values = {2.0, 4.0}};
  const redesign::GoalFigure light{
      .value = 0.6, .error = 0.1, .hands = 2, .lost = 1, .values = {0.5, 0.7}};
  const redesign::GoalFigure all = figure_of_uses(uses, {firm, light});
  EXPECT_NEAR(all.value, 0.75 * 3.0 / 4.0 + 0.25 * 0.6 / 0.5, 1e-12);
  EXPECT_EQ(all.hands, 4);
  EXPECT_EQ(all.lost, 1);
  EXPECT_NEAR(all.error, 0.75 * 0.1 + 0.25 * 0.2, 1e-12);
  // The first hand of both uses, then the others; their mean is the figure.
  const double a = 2.0 * 0.75 / 4.0, b = 2.0 * 0.25 / 0.5;
  ASSERT_EQ(all.values.size(), 4U);
  const std::vector<double> expected = {2.0 * a, 0.5 * b, 4.0 * a, 0.7 * b};
  double mean = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(all.values[i], expected[i], 1e-12) << i;
    mean += 0.25 * all.values[i];
  }
  EXPECT_NEAR(mean, all.value, 1e-12);
  uses.back().figure.value = 0.0;
  EXPECT_THAT(
      [&] {
        figure_of_uses(uses, {firm, light});
      },
      ThrowsMessage<UsageError>(HasSubstr("0 with the original")));
}

TEST(FairUses, AreThoseThatNoOtherCandidateBeatsInEveryUse) {
  SearchStory story;
  story.uses = {"right", "left"};
  const std::vector<std::vector<double>> shares = {{1.0, 1.0},  {0.8, 0.95}, {0.9, 0.85},
                                                   {0.9, 0.96}, {0.7, 1.1},  {0.8, 0.95}};
  for (const std::vector<double>& one : shares) {
    redesign::SearchTrial trial;
    trial.is_feasible = true;
    story.result.history.push_back(trial);
    story.beside.emplace_back();
    story.beside.back().by_use = one;
  }
  // The fourth is beaten by the third, the first by several; equals don't beat each other.
  EXPECT_THAT(fair_uses(story), ElementsAre(4, 1, 5, 2));
  story.result.history[4].is_feasible = false;
  EXPECT_THAT(fair_uses(story), ElementsAre(1, 5, 2));
  story.result.best = 1;
  ASSERT_EQ(uses_figures(story).size(), 1U);
  const std::string svg = report::to_svg(uses_figures(story).front());
  EXPECT_THAT(svg, HasSubstr("candidates of the front: 2, 6, 3"));
}

}  // namespace
}  // namespace palmar::workflow
