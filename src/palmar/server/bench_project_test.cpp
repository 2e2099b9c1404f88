// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/records/assessment/assessment_json.h"
#include "palmar/server/live_worker_fixture.h"
#include "palmar/workflow/assess_bench.h"

namespace palmar::server {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A project about an example, as the workbench's page writes it.
class BenchProjectFile : public ::testing::Test {
 protected:
  void SetUp() override {
    product = shelf.add_example("round-handle");
    project = {{"palmar_project", 1},
               {"product",
                {{"file_name", product.file_name},
                 {"unit", "mm"},
                 {"bytes_base64", formats::base64(formats::read_file(product.path))}}},
               {"hand", {{"person", nullptr}, {"left", false}}},
               {"grip_force_n", nullptr},
               {"hold", 1},
               {"pose", nullptr},
               {"settle", nullptr}};
  }
  std::filesystem::path written() const {
    std::filesystem::path path = product.path.parent_path() / "mine.palmar-project";
    formats::write_file(path, project.dump());
    return path;
  }
  workflow::AssessOutcome assessed() const {
    workflow::BenchAssessRequest request;
    request.file = written();
    return workflow::assess_bench_project(request);
  }
  /// All figures and words of what the command line says.
  json command_line() const {
    const workflow::AssessOutcome outcome = assessed();
    return comparable(json::parse(records::assessment_json(outcome.set, outcome.words)));
  }
  /// Without what differs from run to run.
  static json comparable(json said) {
    said.erase("command_line");
    for (json& one : said["assessments"]) {
      one.erase("times_s");
      one["product"].erase("source");
    }
    return said;
  }

  ProductShelf shelf;
  ShelvedProduct product;
  json project;
};

TEST_F(BenchProjectFile, ThoroughGivesTheFiguresOfTheBenchToTheLastDigit) {
  const auto shared = std::make_shared<ProductShelf>();
  LiveRequest open;
  open.verb = LiveVerb::kOpen;
  open.id = 1;
  open.product = shared->add_example("round-handle").key;
  open.person = workflow::PersonOfSize{grasp::Sex::kFemale, 5.0};
  open.is_left = true;
  LiveAnswers answers;
  LiveWorker worker(shared, answers.sink());
  worker.post(open);
  answers.wait_for("opened", 1);
  project["hand"] = {{"person", "woman:P5"}, {"left", true}};

  // The first hold with the usual force of that person.
  LiveRequest hold;
  hold.verb = LiveVerb::kHold;
  hold.id = 2;
  worker.post(hold);
  const json held = answers.wait_for("result", 2);
  EXPECT_EQ(comparable(held["assessment"]), command_line());

  // From a place beside it: as placed, come to rest with 45 N, closed.
  json angles = json::array();
  const json& posture = held["posture"]["posture"];
  workflow::LivePose pose;
  for (int d = 0; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    angles.push_back(posture[std::string(name_of(dof)) + "_deg"]);
  }
  json place = held["posture"]["product_from_hand"];
  place["translation_mm"][2] = place["translation_mm"][2].get<double>() - 0.7;
  project["pose"] = {{"posture_deg", angles},
                     {"quaternion_wxyz", place["quaternion_wxyz"]},
                     {"translation_mm", place["translation_mm"]},
                     {"grip", held["posture"]["grip"]}};
  project["grip_force_n"] = 45;
  int id = 3;
  for (const char* what : {"evaluate", "rest", "close"}) {
    const json request = {{"do", what},
                          {"id", id},
                          {"posture_deg", angles},
                          {"product_from_hand", place},
                          {"grip", held["posture"]["grip"]},
                          {"grip_force_n", 45}};
    worker.post(parse_live_request(request.dump()));
    const json result = answers.wait_for("result", id);
    project["settle"] = what == std::string("evaluate") ? json(nullptr) : json(what);
    EXPECT_EQ(comparable(result["assessment"]), command_line()) << what;
    ++id;
  }
}

TEST_F(BenchProjectFile, GripForceOfTheCommandLineWins) {
  project["grip_force_n"] = 80;
  workflow::BenchAssessRequest request;
  request.file = written();
  request.grip_force = 35.0;
  const workflow::AssessOutcome outcome = workflow::assess_bench_project(request);
  const study::Assessment& assessment = outcome.set.assessments.front().assessment;
  EXPECT_NEAR(assessment.balance.grip_force, 35.0, 1.0);  // as near as it comes to rest
}

TEST_F(BenchProjectFile, SaysWhatIsWrongByTheFilesOwnNames) {
  const auto message = [&](std::optional<double> force = {}) -> std::string {
    workflow::BenchAssessRequest request;
    request.file = written();
    request.grip_force = force;
    try {
      workflow::assess_bench_project(request);
    } catch (const Error& error) {
      return std::to_string(error.exit_code()) + " " + error.what();
    }
    return "nothing";
  };
  const json whole = project;
  project["product"]["bytes_base64"] = formats::base64("solid nothing\nthis is no facet\n");
  std::string said = message();
  EXPECT_THAT(said, testing::StartsWith("3 "));
  EXPECT_THAT(said, HasSubstr("mine.palmar-project: its product round-handle.stl"));
  project = whole;
  project["hand"]["person"] = "child:P5";
  said = message();
  EXPECT_THAT(said, testing::StartsWith("3 "));
  EXPECT_THAT(said, HasSubstr("child:P5"));
  project = whole;
  project["hold"] = 900;
  EXPECT_THAT(message(), testing::StartsWith("2 "));
  project = whole;
  project["pose"] = {{"posture_deg", std::vector<double>(hand::kDofCount, 0.0)},
                     {"quaternion_wxyz", {1, 0, 0, 0}},
                     {"translation_mm", {0, 0, 0}},
                     {"grip", "medium_wrap"}};
  said = message(30.0);
  EXPECT_THAT(said, testing::StartsWith("2 "));
  EXPECT_THAT(said, HasSubstr("as they were placed"));
}

}  // namespace
}  // namespace palmar::server
