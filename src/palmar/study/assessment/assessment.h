// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/footprint/footprint.h"
#include "palmar/contact/friction/friction.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/rest/balance.h"
#include "palmar/product/product.h"
#include "palmar/study/assessment/certainty.h"
#include "palmar/study/assessment/face_contacts.h"
#include "palmar/study/assessment/grasp_indices.h"
#include "palmar/study/sensors/measured_pressure.h"

namespace palmar::study {

struct AssessOptions {
  grasp::GraspOptions grasp;
  grasp::BalanceOptions balance;  ///< on unless switched off
  contact::ContactOptions contact;
  IndexOptions indices;
  contact::FrictionOptions friction;    ///< off unless it has a coefficient
  std::optional<SensorLayout> sensors;  ///< laid between hand and product
  bool footprint = true;                ///< map the pressure to the product
  std::uint64_t seed =
      0;  ///< written into the results; the power grasp itself draws no random numbers
};

/// Seconds spent, for the record; not part of the deterministic result.
struct AssessTimes {
  double grasp = 0.0;     ///< s
  double contact = 0.0;   ///< s
  double friction = 0.0;  ///< s
  double indices = 0.0;   ///< s
  double balance = 0.0;   ///< s
};

/// One hand holding one product: grasp, contact, footprint.
struct Assessment {
  std::string hand_name;
  grasp::Grasp grasp;      ///< posture and placement at rest; stops as the hand was closed
  grasp::Balance balance;  ///< how it came to rest
  std::optional<Certainty> certainty;  ///< of what came to rest, if `balance` looked nearby
  std::vector<Vec3> posed_skin;        ///< hand frame, mm
  contact::ContactResult contact;
  contact::FrictionResult friction;
  contact::ProductFootprint footprint;
  std::vector<FaceContact> faces;  ///< touched; empty without footprint or faces of the product
  std::optional<SensorReading> sensors;        ///< of a product that is touched, if asked for
  std::optional<PressureComparison> measured;  ///< beside `sensors`
  grasp::GraspIndices indices;                 ///< empty if switched off
  AssessOptions options;
  AssessTimes times;
};

struct ErrorBudget;

/// A product with what came of it.
struct AssessedProduct {
  product::Product product;
  Assessment assessment;
  /// Ways to hold the product, of which one was taken, and the hand that they were ranked with;
  /// null where nothing was ranked.
  std::shared_ptr<const grasp::RankedHolds> ways = nullptr;
  std::shared_ptr<const hand::Hand> ways_hand = nullptr;
  std::shared_ptr<const ErrorBudget> errors = nullptr;  ///< if it was asked for
};

/// Grip force with which it rests [N]; of what doesn't rest that of its contact, of a grasp that
/// slips out that of the hand as it was closed.
double grip_force_of(const AssessedProduct& one);

/// What one `palmar assess` found: one hand, one or more products.
struct AssessmentSet {
  std::shared_ptr<const hand::Hand> hand;
  std::vector<AssessedProduct> assessments;
  std::string command_line;  ///< for provenance
};

/// What a given way of holding does to hand and product: contact, friction, footprint. Posture and
/// placement are taken as they are, from find_grasp() or from a measurement; `balance` says how
/// they came to rest, if they did. Throws UsageError,
/// Cancelled.
Assessment evaluate(const contact::PreparedHand& hand, const product::Product& product,
                    const grasp::Grasp& grasp, const AssessOptions& options = {},
                    const Progress& progress = {}, grasp::Balance balance = {});

/// Grasps the product, lets it come to rest and evaluates that. A product that can't be held gives
/// an assessment whose grasp says why; one that slips out is partly held and shown as the hand was
/// closed. `hold` finds the grasp; unset: find_grasp() with the options. Throws UsageError,
/// Cancelled.
Assessment assess(const contact::PreparedHand& hand, const product::Product& product,
                  const AssessOptions& options = {}, const Progress& progress = {},
                  const std::function<grasp::Grasp(const Progress&)>& hold = {});

}  // namespace palmar::study
