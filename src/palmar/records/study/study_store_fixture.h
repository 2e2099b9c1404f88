// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "palmar/hand/skin/thumb_cmc.h"
#include "palmar/records/product/made_product.h"
#include "palmar/records/study/study_store.h"

namespace palmar::records::study_fixture {

namespace fs = std::filesystem;

inline geometry::TriangleMesh tetrahedron(double size) {
  return {{{0, 0, 0}, {size, 0, 0.1}, {0, size / 3, 0}, {0, 0, size}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// No hand that could hold anything: the store doesn't look at it.
inline hand::Hand stored_hand() {
  hand::Hand hand;
  hand.name = "stored";
  hand.skin = tetrahedron(50.0 / 7);
  hand.segment.assign(4, hand::Segment::kPalm);
  hand.region.assign(4, hand::Region::kThenar);
  for (int j = 0; j < hand::kJointCount; ++j) {
    hand.skeleton.joints[j] = {static_cast<hand::JointId>(j), Vec3(j, 1, 2), {}};
  }
  for (int d = 0; d < hand::kDofCount; ++d) {
    hand::JointDof dof;
    dof.dof = static_cast<hand::Dof>(d);
    dof.axis = Vec3(1, d / 7.0, 0).normalized();
    dof.lower = -1;
    dof.upper = 3;
    hand.skeleton.joints[d % hand::kJointCount].dofs.push_back(dof);
  }
  hand.skeleton.fingertips.fill(Vec3(8, 180, 1.0 / 3));
  hand.skeleton.thumb_cmc = hand::make_cmc_limits(hand::make_cmc_joint({28, 36, 19}, {45, 59, 34}));
  hand.weights = {{hand::JointId::kWrist, {0, 2}, {0.1, 1}, {1.0 / 3, 1}, {}}};
  hand.tissue = hand::default_tissue();
  return hand;
}

struct Study {
  study::StudyPlan plan;
  study::StudyInputs inputs;
};

/// 5 hands x 2 products x 2 grips.
inline Study small_study() {
  Study study;
  study::StudyPlan& plan = study.plan;
  plan.name = "small";
  plan.title = "Small \"study\", äöü";
  plan.seed = 7;
  plan.populations.push_back({});
  plan.populations[0].population.name = "given";
  plan.profiles.push_back({});
  for (int h = 0; h < 5; ++h) {
    study::StudyHand hand;
    hand.sample.label = "person " + std::to_string(h);
    hand.sample.sex = h % 2 == 0 ? grasp::Sex::kMale : grasp::Sex::kFemale;
    hand.sample.dimensions = {{*hand::hand_dimension_named("hand_length"), 180.0 + h / 3.0}};
    plan.hands.push_back(hand);
  }
  const MadeProduct made{"cylinder", {{"diameter_mm", 35.0}, {"length_mm", 20.0}}};
  study::StudyProduct cylinder;
  cylinder.name = cylinder.family = "cylinder";
  cylinder.file = words_of(made);
  study::StudyProduct file = cylinder;
  file.name = file.family = "tetrahedron";
  file.file = "tetrahedron.stl";
  file.at = Vec3(1.0 / 3.0, 2, 3);
  study.inputs.products = {make_solid(made), {}};
  study.inputs.products[1].mesh = tetrahedron(31.0);
  cylinder.content_hash = content_hash(study.inputs.products[0].mesh);
  file.content_hash = content_hash(study.inputs.products[1].mesh);
  plan.products = {cylinder, file};
  plan.grips = {std::nullopt, grasp::Grip::kTripod};
  plan.settings.push_back({});
  plan.limits.push_back({"force_n", std::nullopt, 50.0});
  study.inputs.base = std::make_shared<const hand::Hand>(stored_hand());
  plan.hand_hash = content_hash(*study.inputs.base);
  return study;
}

/// A record with something everywhere, numbers without a short binary form.
inline study::StudyRecord record_for(std::int64_t number) {
  study::StudyRecord record;
  record.number = number;
  const double x = static_cast<double>(number) / 7.0;
  record.outcome = number % 6 == 5 ? study::StudyOutcome::kFailed : study::StudyOutcome::kHeld;
  if (record.outcome == study::StudyOutcome::kFailed) {
    record.reason = "no, \"reason\"";
    return record;
  }
  record.grip = number % 2 == 0 ? grasp::Grip::kMediumWrap : grasp::Grip::kTripod;
  record.is_balanced = number % 3 == 0;
  if (number % 4 != 2) {  // the others are placed by coordinates
    study::StudyHold held;
    held.hold.part = 2;
    held.hold.part_name = "handle";
    held.hold.grip = record.grip;
    held.hold.along = x / 3.0;
    held.hold.edge = -x / 9.0;
    held.hold.toward = number % 2 == 0 ? 1 : -1;
    held.hold.turn = x;
    held.hold.is_over_end = number % 3 == 1;
    if (number % 3 != 0) held.kind = product::PartKind::kLoop;
    held.words = "medium wrap of the \"handle\"";
    record.hold = held;
  }
  record.force = 10.0 + x;
  record.grip_force = 5.0 + x;
  record.area = 1000.0 * x;
  record.peak_pressure = 0.1 * x;
  record.peak_pressure_cells = 0.05 * x;
  record.mean_pressure = 0.01 * x;
  record.demand = {x / 10.0, 3 * x, 2 * x};
  record.regions = {{hand::Region::kThumbDistal, x, 2 * x, 3 * x, 4 * x, 5 * x},
                    {hand::Region::kThenar, x, x, x, x, x / 3.0}};
  record.indices = {{"grip_force_n", 5.0 + x}, {"friction_in_use", x / 11.0}};
  // Not in the catalogue, in an order of their own, not in every record.
  if (number % 3 != 1) record.indices.push_back({"another_quantity", x});
  if (number % 3 != 0) record.indices.push_back({"a_quantity", 2 * x});
  for (std::size_t d = 0; d < record.posture.angle.size(); ++d) {
    record.posture.angle[d] = x + static_cast<double>(d) / 9.0;
  }
  record.product_from_hand = geometry::Rigid3::about_axis(Vec3(0, 0.6, 0.8), Vec3(1, 2, 3), x);
  for (int v = 0; v < 200; v += 1 + static_cast<int>(number % 3)) {
    record.skin_pressure.vertex.push_back(300 * v + 1);
    record.skin_pressure.value.push_back(static_cast<float>(0.01 * v + x));
  }
  if (number % 5 == 3) {
    record.fallbacks.lemke_solutions = static_cast<int>(number);
    record.fallbacks.band_levels = 1;
  }
  record.seconds = 0.5 + x;
  return record;
}

inline void expect_same(const study::StudyRecord& a, const study::StudyRecord& b) {
  EXPECT_EQ(a.number, b.number);
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.grip, b.grip);
  EXPECT_EQ(a.is_balanced, b.is_balanced);
  ASSERT_EQ(a.hold.has_value(), b.hold.has_value());
  if (a.hold) {
    EXPECT_TRUE(study::is_same(*a.hold, *b.hold));
    EXPECT_EQ(a.hold->kind, b.hold->kind);
    EXPECT_EQ(a.hold->hold.part_name, b.hold->hold.part_name);
  }
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(a.grip_force, b.grip_force);
  EXPECT_EQ(a.area, b.area);
  EXPECT_EQ(a.peak_pressure, b.peak_pressure);
  EXPECT_EQ(a.peak_pressure_cells, b.peak_pressure_cells);
  EXPECT_EQ(a.mean_pressure, b.mean_pressure);
  EXPECT_EQ(a.demand.range_share, b.demand.range_share);
  EXPECT_EQ(a.demand.grip_strength, b.demand.grip_strength);
  EXPECT_EQ(a.demand.nail_room, b.demand.nail_room);
  ASSERT_EQ(a.regions.size(), b.regions.size());
  for (std::size_t i = 0; i < a.regions.size(); ++i) {
    EXPECT_EQ(a.regions[i].region, b.regions[i].region);
    EXPECT_EQ(a.regions[i].mean_pressure, b.regions[i].mean_pressure);
  }
  const auto values = [](const study::StudyRecord& record) {
    std::map<std::string, double> result;
    for (const study::IndexRecord& index : record.indices) result[index.key] = index.value;
    return result;
  };
  EXPECT_EQ(values(a), values(b));
  EXPECT_EQ(a.posture.angle, b.posture.angle);
  EXPECT_EQ(a.product_from_hand.rotation.coeffs(), b.product_from_hand.rotation.coeffs());
  EXPECT_EQ(a.product_from_hand.translation, b.product_from_hand.translation);
  EXPECT_EQ(a.skin_pressure.vertex, b.skin_pressure.vertex);
  EXPECT_EQ(a.skin_pressure.value, b.skin_pressure.value);
  EXPECT_EQ(a.product_pressure.vertex, b.product_pressure.vertex);
  EXPECT_EQ(a.fallbacks, b.fallbacks);
}

inline void fill(const fs::path& path, const std::vector<std::int64_t>& numbers) {
  StudyStore store(path, StudyAccess::kWrite);
  for (const std::int64_t number : numbers) store.keep(record_for(number));
}

/// A finished store whose grasps came in this order.
inline void make_store(const fs::path& path, const Study& study, std::vector<std::int64_t> order,
                       study::StudyShard shard = {}) {
  StudyStore::create(path, study.plan, study.inputs, shard);
  fill(path, order);
  StudyStore store(path, StudyAccess::kWrite);
  store.finish();
}

}  // namespace palmar::records::study_fixture
