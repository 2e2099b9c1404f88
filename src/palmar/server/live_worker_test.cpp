// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/live_worker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "palmar/server/live_frame.h"
#include "palmar/server/live_worker_fixture.h"

namespace palmar::server {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::shared_ptr<ProductShelf>& shelf() {
  static const auto one = std::make_shared<ProductShelf>();
  return one;
}

LiveRequest opening(int id) {
  static const std::string key = shelf()->add_example("round-handle").key;
  LiveRequest request;
  request.verb = LiveVerb::kOpen;
  request.id = static_cast<std::uint32_t>(id);
  request.product = key;
  return request;
}

LiveRequest holding(int id, double force) {
  LiveRequest request;
  request.verb = LiveVerb::kHold;
  request.id = static_cast<std::uint32_t>(id);
  request.task.rest.grip_force = force;
  return request;
}

LiveRequest moving(int id, const geometry::Rigid3& place) {
  LiveRequest request;
  request.verb = LiveVerb::kMove;
  request.id = static_cast<std::uint32_t>(id);
  request.pose.product_from_hand = place;
  return request;
}

TEST(LiveWorker, OpensHoldsAndMoves) {
  LiveAnswers answers;
  LiveWorker worker(shelf(), answers.sink());
  worker.post(opening(1));
  const json opened = answers.wait_for("opened", 1);
  EXPECT_GE(opened["holds"].size(), 1U);
  EXPECT_EQ(opened["hand"]["angles"].size(), 23U);
  EXPECT_EQ(opened["hand"]["regions"].size(), 20U);
  EXPECT_EQ(opened["colours"]["table"].size(), 256U);

  worker.post(holding(2, 60.0));
  const json result = answers.wait_for("result", 2);
  EXPECT_THAT(result["command"].get<std::string>(),
              testing::EndsWith("round-handle.stl --unit mm --hold 1 --grip-force-n 60"));
  const json& assessed = result["assessment"]["assessments"][0];
  EXPECT_GT(assessed["contact"]["peak_pressure_mpa"].get<double>(), 0.02);
  const auto& t = result["posture"]["product_from_hand"]["translation_mm"];
  // Far from the hand nothing is touched; still a frame comes.
  worker.post(moving(3, {Quat::Identity(), Vec3(t[0], t[1], t[2].get<double>() + 300.0)}));
  EXPECT_EQ(answers.wait_for("frame", 3)["kind"], static_cast<int>(FrameKind::kMoving));
}

TEST(LiveWorker, NewestRequestWins) {
  LiveAnswers answers;
  LiveWorker worker(shelf(), answers.sink());
  worker.post(opening(1));
  for (int id = 2; id < 20; ++id) worker.post(holding(id, 40.0 + id));
  worker.post(holding(20, 60.0));
  answers.wait_for("result", 20);
  EXPECT_EQ(answers.count("opened"), 1) << "a product that is opened is waited for";
  EXPECT_EQ(answers.count("result"), 1);
  EXPECT_EQ(answers.count("dropped"), 18);
}

TEST(LiveWorker, WorkIsCancelledByAMove) {
  LiveAnswers answers;
  LiveWorker worker(shelf(), answers.sink());
  worker.post(opening(1));
  answers.wait_for("opened", 1);
  worker.post(holding(2, 60.0));
  answers.wait_for("progress", 2);
  const auto start = std::chrono::steady_clock::now();
  worker.post(moving(3, {}));
  answers.wait_for("frame", 3);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  answers.wait_for("dropped", 2);
}

TEST(LiveWorker, ErrorsAreAnswersAndTheWorkerGoesOn) {
  LiveAnswers answers;
  LiveWorker worker(shelf(), answers.sink());
  worker.post(holding(1, 60.0));
  EXPECT_THAT(answers.wait_for("error", 1)["message"].get<std::string>(),
              HasSubstr("no product is open"));
  LiveRequest unknown = opening(2);
  unknown.product = "p999";
  worker.post(unknown);
  EXPECT_THAT(answers.wait_for("error", 2)["message"].get<std::string>(), HasSubstr("p999"));
  worker.post(opening(3));
  answers.wait_for("opened", 3);
  LiveRequest beyond = holding(4, 60.0);
  beyond.number = 500;
  worker.post(beyond);
  EXPECT_EQ(answers.wait_for("error", 4)["code"], 2);
}

TEST(LiveWorker, StopsWhileItComputes) {
  LiveAnswers answers;
  const auto start = std::chrono::steady_clock::now();
  {
    LiveWorker worker(shelf(), answers.sink());
    worker.post(opening(1));
    answers.wait_for("progress", 1);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

}  // namespace
}  // namespace palmar::server
