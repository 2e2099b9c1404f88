// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/study/study_plan.h"

namespace palmar::study {

/// A field on the vertices of a mesh that is 0 almost everywhere.
struct SparseField {
  std::vector<int> vertex;  ///< ascending
  std::vector<float> value;
};

enum class StudyOutcome {
  kHeld,
  kPartlyHeld,
  kSlipsOut,
  kTooLarge,
  kTooSmall,
  kNotGraspable,
  kFailed  ///< no answer: `reason` says which method gave up on what
};
std::string name_of(StudyOutcome outcome);  ///< "held", "slips_out", ...

struct RegionRecord {
  hand::Region region{};
  double force = 0.0;                ///< N
  double area = 0.0;                 ///< mm^2
  double peak_pressure = 0.0;        ///< MPa
  double peak_pressure_cells = 0.0;  ///< MPa
  double mean_pressure = 0.0;        ///< MPa
};

struct IndexRecord {
  std::string key;  ///< as GraspIndex::key
  double value = 0.0;
};

/// By which part of the product a hand holds it, and how.
struct StudyHold {
  grasp::Hold hold;                       ///< without its fingertips
  std::optional<product::PartKind> kind;  ///< of the part
  std::string words;                      ///< "medium wrap of the handle, 40 % along it"
};
bool is_same(const StudyHold& a, const StudyHold& b);

/// What a grasp asks of its owner; decides who is excluded (docs/method/profiles.md).
struct GraspDemand {
  double range_share = 0.0;    ///< smallest HandProfile::range_share that allows the posture
  double grip_strength = 0.0;  ///< N; smallest that holds the task's force, 0 without
  double nail_room = 0.0;      ///< mm; longest nail that touches nothing
};

/// One finished grasp of a study: a pure function of plan and task.
struct StudyRecord {
  std::int64_t number = 0;  ///< of the task
  StudyOutcome outcome = StudyOutcome::kFailed;
  std::string reason;  ///< empty if held
  grasp::Grip grip = grasp::Grip::kMediumWrap;
  bool is_balanced = false;
  std::optional<StudyHold> hold;  ///< nothing: placed by coordinates, or of an older study
  // Of the whole hand; 0 without contact.
  double force = 0.0;                ///< N; sum of normal forces
  double grip_force = 0.0;           ///< N; across the plane of largest squeeze
  double area = 0.0;                 ///< mm^2
  double peak_pressure = 0.0;        ///< MPa, of one vertex
  double peak_pressure_cells = 0.0;  ///< MPa, of one sensor cell
  double mean_pressure = 0.0;        ///< MPa
  GraspDemand demand;
  std::vector<RegionRecord> regions;  ///< in contact, ascending
  std::vector<IndexRecord> indices;   ///< those with a value
  hand::Posture posture;
  geometry::Rigid3 product_from_hand;
  contact::ContactFallbacks fallbacks;  ///< on the way to rest and of the contact in the end
  SparseField skin_pressure;            ///< MPa, per vertex of the hand's skin
  SparseField product_pressure;         ///< MPa, per vertex of the product's map (product_map())
  double seconds = 0.0;                 ///< spent; not a result
};

/// The mesh on which a product's pressure maps are kept: its own, split until no edge is longer
/// than `edge` mm. The same for all hands.
geometry::TriangleMesh product_map(const geometry::TriangleMesh& product, double edge = 3.0);

/// That mesh, and what its triangles are of the product.
struct ProductMap {
  geometry::TriangleMesh mesh;
  std::vector<int> parent;            ///< per triangle: the product's triangle it is a part of
  std::vector<int> face_of_triangle;  ///< index into Product::faces; empty if it has none
};
ProductMap product_map(const product::Product& product, double edge = 3.0);

}  // namespace palmar::study
