// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/live_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "palmar/core/error.h"

namespace palmar::server {
namespace {

using testing::HasSubstr;

std::string angles(const std::string& first = "0") {
  std::string text = "[" + first;
  for (int k = 1; k < 23; ++k) text += ",0";
  return text + "]";
}

std::string move_message(const std::string& posture, const std::string& translation = "[1,2,3]") {
  return R"({"do":"move","id":5,"posture_deg":)" + posture +
         R"(,"product_from_hand":{"quaternion_wxyz":[1,0,0,0],"translation_mm":)" + translation +
         "}}";
}

std::string refused_as(const std::string& text) {
  try {
    parse_live_request(text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LiveRequest, MoveHasAnglesInDegreesAndAPlace) {
  const LiveRequest request = parse_live_request(move_message(angles("90")));
  EXPECT_EQ(request.verb, LiveVerb::kMove);
  EXPECT_EQ(request.id, 5U);
  EXPECT_NEAR(request.pose.posture.angle[0], 0.5 * std::numbers::pi, 1e-12);
  EXPECT_EQ(request.pose.product_from_hand.translation, Vec3(1, 2, 3));
}

TEST(LiveRequest, OpenSaysWhoseHand) {
  const LiveRequest request = parse_live_request(
      R"({"do":"open","id":1,"product":"p2","person":"woman:P5","left":true,"language":"de"})");
  EXPECT_EQ(request.product, "p2");
  ASSERT_TRUE(request.person.has_value());
  EXPECT_EQ(request.person->sex, grasp::Sex::kFemale);
  EXPECT_EQ(request.person->percentile, 5.0);
  EXPECT_TRUE(request.is_left);
  EXPECT_EQ(request.language, Language::kGerman);
  EXPECT_FALSE(parse_live_request(R"({"do":"open","id":1,"product":"p2","person":null})").person);
}

TEST(LiveRequest, HoldHasATask) {
  const LiveRequest request =
      parse_live_request(R"({"do":"hold","id":3,"number":2,"grip_force_n":60,"mass_kg":0.4})");
  EXPECT_EQ(request.number, 2);
  EXPECT_EQ(request.task.rest.grip_force, 60.0);
  EXPECT_EQ(request.task.friction.mass, 0.4);
  EXPECT_TRUE(parse_live_request(R"({"do":"hold","id":3,"number":2})").task.rest.is_usual());
}

TEST(LiveRequest, PersonsReadBack) {
  for (const char* text : {"woman:P5", "man:P97.5"}) {
    EXPECT_EQ(workflow::person_argument(workflow::parse_person_of_size(text)), text);
  }
}

TEST(LiveRequest, WhatIsWrongIsNamed) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "is no JSON object"},
      {"[]", "is no JSON object"},
      {"{\"do\":", "is no JSON object"},
      {"{}", "\"do\" is missing"},
      {R"({"do":7,"id":1})", "\"do\" is \"7\""},
      {R"({"do":"fly","id":1})", "\"do\" is \"fly\"; open, hold"},
      {R"({"do":"open"})", "\"id\" is missing"},
      {R"({"do":"open","id":-1,"product":"p"})", "\"id\" is \"-1\""},
      {R"({"do":"open","id":1.5,"product":"p"})", "\"id\" is \"1.5\""},
      {R"({"do":"open","id":1})", "\"product\" is missing"},
      {R"({"do":"open","id":1,"product":"p","person":"child:P5"})", "person is \"child:P5\""},
      {R"({"do":"open","id":1,"product":"p","person":"man:P0"})", "percentile"},
      {R"({"do":"open","id":1,"product":"p","left":"yes"})", "\"left\""},
      {R"({"do":"open","id":1,"product":"p","language":"xx"})", "xx"},
      {R"({"do":"hold","id":1,"number":0})", "\"number\" is \"0\"; a whole number from 1"},
      {R"({"do":"hold","id":1,"number":1,"grip_force_n":"60"})", "\"grip_force_n\""},
      {R"({"do":"hold","id":1,"number":1,"grip_force_n":1e9})", "a number from 0.1 to 2000"},
      {move_message("[1,2]"), "a list of 23 angles"},
      {move_message(angles("\"x\"")), "an angle within a full turn"},
      {move_message(angles("1e5")), "an angle within a full turn"},
      {move_message(angles(), "[1,2]"), "\"product_from_hand\""},
      {move_message(angles(), "[1e9,0,0]"), "10 m away"},
      {R"({"do":"move","id":1})", "\"posture_deg\" is missing"},
      {R"({"do":"close","id":1})", "\"posture_deg\" is missing"},
  };
  for (const auto& [text, words] : cases) EXPECT_THAT(refused_as(text), HasSubstr(words)) << text;
}

TEST(LiveRequest, DamagedMessagesAreRefusedAndNothingElse) {
  const std::string good = move_message(angles("12.5"));
  std::mt19937 random(1);
  int refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = good;
    const int changes = 1 + static_cast<int>(random() % 4U);
    for (int k = 0; k < changes; ++k) {
      const std::size_t at = random() % text.size();
      switch (random() % 3U) {
        case 0:
          text[at] = static_cast<char>(random() % 256U);
          break;
        case 1:
          text.erase(at, 1 + random() % 20U);
          break;
        default:
          text.insert(at, 1, static_cast<char>(random() % 256U));
      }
      if (text.empty()) text = "{";
    }
    try {
      const LiveRequest request = parse_live_request(text);
      for (const double angle : request.pose.posture.angle) EXPECT_TRUE(std::isfinite(angle));
    } catch (const UsageError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 2000);
}

}  // namespace
}  // namespace palmar::server
