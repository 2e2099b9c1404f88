// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_records/hand_from_scan_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "palmar/geometry/degrees.h"
#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/records/json_values.h"

namespace palmar::person_records {
namespace {

using Json = nlohmann::ordered_json;

std::string text(std::string_view name) { return std::string(name); }

std::string tape_name(const hand::TapeValue& value) {
  return (value.segment ? text(name_of(*value.segment)) + "_" : "") + text(value.quantity);
}

Json scan_joints(const capture::HandFromScan& made) {
  const geometry::Rigid3& scan = made.scanned.patient_from_hand;
  Json list = Json::array();
  for (const hand::Joint& joint : made.scanned.hand.skeleton.joints) {
    for (const hand::JointDof& dof : joint.dofs) {
      list.push_back({{"joint", text(name_of(joint.id))},
                      {"dof", text(name_of(dof.dof))},
                      {"axis", records::vector3(dof.axis)},
                      {"centre_mm", records::vector3(dof.centre)},
                      {"axis_in_scan", records::vector3(scan.rotation * dof.axis)},
                      {"centre_in_scan_mm", records::vector3(scan * dof.centre)},
                      {"lower_deg", dof.lower * geometry::kDegreesPerRadian},
                      {"upper_deg", dof.upper * geometry::kDegreesPerRadian},
                      {"reference_deg", dof.reference * geometry::kDegreesPerRadian},
                      {"source", dof.source}});
    }
  }
  return list;
}

}  // namespace

std::string hand_from_scan_json(const capture::HandFromScan& made) {
  const hand::Hand& hand = made.scanned.hand;
  Json dimensions = Json::object();
  for (const hand::HandDimension& d : hand::all_hand_dimensions()) {
    dimensions[text(name_of(d)) + "_mm"] = hand::value_of(hand.dimensions, d);
  }
  Json tape = Json::object();
  for (const hand::TapeValue& value : hand::values_of(made.tape))
    tape[tape_name(value) + "_mm"] = value.value;
  Json scans = Json::object();
  for (const auto& [name, posture] : made.postures) {
    Json one = Json::object();
    Json angles = Json::object();
    for (int d = 0; d < hand::kDofCount; ++d) {
      angles[text(name_of(static_cast<hand::Dof>(d))) + "_deg"] =
          posture[static_cast<hand::Dof>(d)] * geometry::kDegreesPerRadian;
    }
    one["angles"] = std::move(angles);
    if (const auto fit = made.fits.find(name); fit != made.fits.end()) {
      one["fit_mean_mm"] = fit->second.mean;
      one["fit_p95_mm"] = fit->second.percentile_95;
      one["skin_share_seen"] = fit->second.partner_share;
    }
    Json axes = Json::array();
    for (const auto& [segment, joint] : capture::joints_in_scan(made, name).joint) {
      axes.push_back({{"segment", text(name_of(segment))},
                      {"axis", records::vector3(joint.axis)},
                      {"centre_mm", records::vector3(joint.centre)}});
    }
    one["flexion_axes"] = std::move(axes);
    if (const auto limit = made.thumb.find(name); limit != made.thumb.end()) {
      const Eigen::AngleAxisd turn(limit->second.metacarpal.rotation);
      one["thumb_metacarpal"] = {{"turn_deg", turn.angle() * geometry::kDegreesPerRadian},
                                 {"axis", records::vector3(turn.axis())},
                                 {"residual_mm", limit->second.residual},
                                 {"dots", limit->second.dots}};
    }
    scans[text(name_of(name))] = std::move(one);
  }
  Json creases = Json::object();
  for (const auto& [segment, plane] : made.creases.plane) {
    creases[text(name_of(segment))] = {{"point_mm", records::vector3(plane.point)},
                                       {"normal", records::vector3(plane.normal)},
                                       {"distal_of_expected_mm", made.creases.shift.at(segment)}};
  }
  Json missing = Json::array();
  for (const hand::Segment s : made.creases.missing) missing.push_back(text(name_of(s)));
  Json dots = Json::object();
  for (const auto& [segment, count] : made.dots) dots[text(name_of(segment))] = count;
  Json by_dots = Json::array();
  for (const capture::DottedJoint& joint : made.joints) {
    by_dots.push_back({{"segment", text(name_of(joint.segment))},
                       {"posture", text(name_of(joint.posture))},
                       {"turn_deg", joint.turn * geometry::kDegreesPerRadian},
                       {"residual_mm", joint.residual},
                       {"axis_change_deg", joint.axis_change * geometry::kDegreesPerRadian},
                       {"axis_error_deg", joint.axis_error * geometry::kDegreesPerRadian},
                       {"centre_change_mm", joint.centre_change},
                       {"dots", joint.dots}});
  }
  const Json json = {{"hand", hand.name},
                     {"side", text(name_of(hand.side))},
                     {"dimensions", std::move(dimensions)},
                     {"along_the_skin", std::move(tape)},
                     {"skin_mean_mm", made.scanned.registration_mean},
                     {"skin_p95_mm", made.scanned.registration_p95},
                     {"joints", scan_joints(made)},
                     {"scans", std::move(scans)},
                     {"proximal_creases", std::move(creases)},
                     {"creases_not_found", std::move(missing)},
                     {"dots", std::move(dots)},
                     {"joints_by_dots", std::move(by_dots)},
                     {"notes", made.notes}};
  return json.dump(2);
}

records::CsvTable dimension_csv(const hand::HandDimensions& dimensions,
                                const hand::HandTape& tape) {
  records::CsvTable table{{"dimension", "value_mm"}, {}};
  for (const hand::HandDimension& d : hand::all_hand_dimensions()) {
    table.rows.push_back({text(name_of(d)), fmt::format("{:.3f}", hand::value_of(dimensions, d))});
  }
  for (const hand::TapeValue& value : hand::values_of(tape)) {
    table.rows.push_back({tape_name(value), fmt::format("{:.3f}", value.value)});
  }
  return table;
}

records::CsvTable dotted_joint_csv(const capture::HandFromScan& made) {
  records::CsvTable table{{"segment", "posture", "turn_deg", "residual_mm", "axis_change_deg",
                           "axis_error_deg", "centre_change_mm", "dots"},
                          {}};
  for (const capture::DottedJoint& joint : made.joints) {
    table.rows.push_back({text(name_of(joint.segment)), text(name_of(joint.posture)),
                          fmt::format("{:.2f}", joint.turn * geometry::kDegreesPerRadian),
                          fmt::format("{:.3f}", joint.residual),
                          fmt::format("{:.2f}", joint.axis_change * geometry::kDegreesPerRadian),
                          fmt::format("{:.2f}", joint.axis_error * geometry::kDegreesPerRadian),
                          fmt::format("{:.3f}", joint.centre_change), std::to_string(joint.dots)});
  }
  return table;
}

records::CsvTable truth_error_csv(const capture::ScanErrors& errors) {
  records::CsvTable table{{"what", "posture", "segment", "difference_mm", "axis_deg"}, {}};
  for (const hand::HandDimension& d : hand::all_hand_dimensions()) {
    table.rows.push_back({text(name_of(d)), "", "",
                          fmt::format("{:.3f}", hand::value_of(errors.difference, d)), ""});
  }
  for (const capture::PlaceError& e : errors.places) {
    table.rows.push_back(
        {e.axis ? "joint" : "fingertip", text(name_of(e.posture)), text(name_of(e.segment)),
         fmt::format("{:.3f}", e.place),
         e.axis ? fmt::format("{:.2f}", *e.axis * geometry::kDegreesPerRadian) : ""});
  }
  return table;
}

}  // namespace palmar::person_records
