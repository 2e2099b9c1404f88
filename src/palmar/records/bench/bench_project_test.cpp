// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/bench/bench_project.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "palmar/core/error.h"

namespace palmar::records {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ProjectJson = nlohmann::json;

/// As the workbench writes it; "Zm9vYmE=" is "fooba" (RFC 4648, section 10).
ProjectJson whole_project() {
  return {{"palmar_project", 1},
          {"product", {{"file_name", "cup.stl"}, {"unit", "cm"}, {"bytes_base64", "Zm9vYmE="}}},
          {"hand", {{"person", "woman:P5"}, {"left", true}}},
          {"grip_force_n", 42.5},
          {"hold", 3},
          {"pose",
           {{"posture_deg", std::vector<double>(hand::kDofCount, 90.0)},
            {"quaternion_wxyz", {0, 1, 0, 0}},
            {"translation_mm", {1.5, -2, 3}},
            {"grip", "medium_wrap"}}},
          {"settle", "rest"}};
}

std::string complaint(const ProjectJson& json) {
  try {
    parse_bench_project(json.dump());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(BenchProject, IsReadAsTheWorkbenchWritesIt) {
  const BenchProject project = parse_bench_project(whole_project().dump());
  EXPECT_EQ(project.file_name, "cup.stl");
  EXPECT_EQ(project.unit, geometry::LengthUnit::kCentimetre);
  EXPECT_EQ(project.bytes, "fooba");
  EXPECT_EQ(project.person, "woman:P5");
  EXPECT_TRUE(project.is_left);
  EXPECT_EQ(project.grip_force, 42.5);
  EXPECT_EQ(project.hold, 3);
  ASSERT_TRUE(project.pose.has_value());
  EXPECT_DOUBLE_EQ(project.pose->posture.angle[5], std::numbers::pi / 2);
  EXPECT_EQ(project.pose->product_from_hand.translation, Vec3(1.5, -2, 3));
  EXPECT_EQ(project.pose->grip, grasp::Grip::kMediumWrap);
  EXPECT_EQ(project.settle, BenchSettle::kRest);
}

TEST(BenchProject, NothingSaidIsTheTemplateAndTheUsualForce) {
  ProjectJson json = whole_project();
  json["product"]["unit"] = nullptr;
  json["hand"] = {{"person", nullptr}, {"left", false}};
  json["grip_force_n"] = json["pose"] = json["settle"] = nullptr;
  const BenchProject project = parse_bench_project(json.dump());
  EXPECT_FALSE(project.unit || project.grip_force || project.pose || project.is_left);
  EXPECT_EQ(project.person, "");
  EXPECT_EQ(project.settle, BenchSettle::kAsPlaced);
}

TEST(BenchProject, OwnHandComesWithItsFile) {
  ProjectJson json = whole_project();
  json["hand"] = {{"person", nullptr},
                  {"left", false},
                  {"file", {{"file_name", "anna.hand.glb"}, {"bytes_base64", "Zm9vYmE="}}}};
  const BenchProject project = parse_bench_project(json.dump());
  EXPECT_EQ(project.hand_file, "anna.hand.glb");
  EXPECT_EQ(project.hand_bytes, "fooba");
  json["hand"]["person"] = "man:P50";
  EXPECT_THAT(complaint(json), HasSubstr("person"));
  json["hand"] = {{"person", nullptr}, {"left", false}, {"file", {{"file_name", "../x.glb"}}}};
  EXPECT_THAT(complaint(json), AllOf(HasSubstr("file_name"), HasSubstr("without folders")));
}

TEST(BenchProject, ComplaintsNameMemberAndWhatIsRequired) {
  const auto with = [](const char* path, const ProjectJson& value) {
    ProjectJson json = whole_project();
    json[ProjectJson::json_pointer(path)] = value;
    return complaint(json);
  };
  EXPECT_THAT(with("/palmar_project", 2), AllOf(HasSubstr("palmar_project"), HasSubstr("is 2")));
  EXPECT_THAT(with("/product", 7), AllOf(HasSubstr("product"), HasSubstr("an object")));
  EXPECT_THAT(with("/product/file_name", "../cup.stl"), HasSubstr("without folders"));
  EXPECT_THAT(with("/product/file_name", ".."), HasSubstr("without folders"));
  EXPECT_THAT(with("/product/unit", "mile"), AllOf(HasSubstr("unit"), HasSubstr("mile")));
  for (const char* text : {"", "Zg=", "Z!==", "Zm9v=mE=", "===="}) {
    EXPECT_THAT(with("/product/bytes_base64", text), HasSubstr("base64")) << text;
  }
  EXPECT_THAT(with("/hand/left", "yes"), HasSubstr("true or false"));
  EXPECT_THAT(with("/grip_force_n", -3), AllOf(HasSubstr("-3"), HasSubstr("above 0")));
  EXPECT_THAT(with("/hold", 1.5), HasSubstr("a whole number"));
  EXPECT_THAT(with("/pose/posture_deg", {1, 2}), HasSubstr("23 angles"));
  EXPECT_THAT(with("/pose/posture_deg/4", 900), HasSubstr("900"));
  EXPECT_THAT(with("/pose/quaternion_wxyz", {0, 0, 0, 0}), HasSubstr("quaternion"));
  EXPECT_THAT(with("/pose/grip", "fist"), AllOf(HasSubstr("fist"), HasSubstr("grip")));
  EXPECT_THAT(with("/settle", "fall"), HasSubstr("close, rest or null"));
  for (const char* member :
       {"palmar_project", "product", "hand", "grip_force_n", "hold", "pose", "settle"}) {
    ProjectJson json = whole_project();
    json.erase(member);
    EXPECT_THAT(complaint(json), AllOf(HasSubstr(member), HasSubstr("missing")));
  }
}

TEST(BenchProject, WhatIsNoneIsRefused) {
  for (const char* text : {"{\"palmar_project\": 1", "[]", "7"}) {
    EXPECT_THROW(parse_bench_project(text), InputError) << text;
  }
  try {
    read_bench_project("missing.palmar-project");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("missing.palmar-project"));
  }
}

}  // namespace
}  // namespace palmar::records
