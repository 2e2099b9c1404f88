// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/assessment/assessment_json.h"

#include <nlohmann/json.hpp>
#include <set>

#include "palmar/contact/prepared/resolution.h"
#include "palmar/core/version.h"
#include "palmar/geometry/degrees.h"
#include "palmar/records/assessment/index_json.h"
#include "palmar/records/assessment/verdict_json.h"
#include "palmar/records/hold/hold_json.h"
#include "palmar/records/json_values.h"
#include "palmar/records/posture/placement_json.h"
#include "palmar/records/sensors/sensor_json.h"
#include "palmar/study/assessment/error_budget.h"
#include "palmar/study/assessment/hold_doubts.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

/// File names may hold bytes that are no UTF-8; they must not stop the output.
Json posture_object(const hand::Posture& angles) {
  Json posture = Json::object();
  for (int d = 0; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    posture[std::string(name_of(dof)) + "_deg"] = angles[dof] * geometry::kDegreesPerRadian;
  }
  return posture;
}

Json runner_up_object(const grasp::GraspRunnerUp& other) {
  return {{"grip", name_of(other.grip)},
          {"score", other.score},
          {"posture", posture_object(other.posture)},
          {"product_from_hand", placement_with_matrix(other.product_from_hand)}};
}

Json grasp_object(const grasp::Grasp& grasp) {
  Json segments = Json::array();
  for (const grasp::SegmentStop& stop : grasp.stops) {
    segments.push_back({{"segment", name_of(stop.segment)},
                        {"stopped_by", name_of(stop.reason)},
                        {"penetration_mm", stop.penetration}});
  }
  Json fingertips = Json::array();
  for (const grasp::FingertipContact& tip : grasp.fingertips) {
    fingertips.push_back({{"finger", name_of(tip.finger)},
                          {"target_mm", vector3(tip.target)},
                          {"reached_mm", vector3(tip.reached)},
                          {"normal", vector3(tip.normal)},
                          {"miss_mm", tip.miss}});
  }
  Json others = Json::array();
  for (const grasp::GraspRunnerUp& other : grasp.runners_up)
    others.push_back(runner_up_object(other));
  return {{"grip", name_of(grasp.grip)},
          {"status", name_of(grasp.status)},
          {"message", grasp.message},
          {"posture", posture_object(grasp.posture)},
          {"product_from_hand", placement_with_matrix(grasp.product_from_hand)},
          {"grip_point_mm", vector3(grasp.grip_point)},
          {"grip_axis", vector3(grasp.grip_axis)},
          {"grip_girth_mm", grasp.grip_girth},
          {"segments", std::move(segments)},
          {"fingertips", std::move(fingertips)},
          {"score", grasp.score},
          {"candidates", grasp.candidates},
          {"runners_up", std::move(others)}};
}

void add_totals(Json& json, const contact::RegionContact& contact) {
  json["force_n"] = contact.force;
  json["contact_area_mm2"] = contact.area;
  json["peak_pressure_mpa"] = contact.peak_pressure;
  json["peak_pressure_cells_mpa"] = contact.peak_pressure_cells;
  json["unresolved_force_n"] = contact.unresolved_force;
  json["mean_pressure_mpa"] = contact.mean_pressure;
  json["force_vector_n"] = vector3(contact.force_vector);
  json["centre_mm"] = vector3(contact.centre);
  json["max_penetration_mm"] = contact.max_penetration;
}

std::string name_of_status(contact::ContactStatus status) {
  switch (status) {
    case contact::ContactStatus::kSolved:
      return "solved";
    case contact::ContactStatus::kNoContact:
      return "no_contact";
    case contact::ContactStatus::kNotConverged:
      return "not_converged";
    case contact::ContactStatus::kTooDeep:
      return "too_deep";
  }
  return "unknown";
}

/// Low, nominal and high tissue. `is_low`, `is_high`: whether there is a solution for that tissue.
Json band_object(const contact::ContactBandRow& row, const contact::RegionContact& nominal,
                 bool is_low, bool is_high) {
  const auto three = [&](double low, double middle, double high) {
    return Json{{"low", is_low ? Json(low) : Json(nullptr)},
                {"nominal", middle},
                {"high", is_high ? Json(high) : Json(nullptr)}};
  };
  return {
      {"force_n", three(row.force_low, nominal.force, row.force_high)},
      {"contact_area_mm2", three(row.area_low, nominal.area, row.area_high)},
      {"peak_pressure_mpa",
       three(row.peak_pressure_low, nominal.peak_pressure, row.peak_pressure_high)},
      {"peak_pressure_cells_mpa", three(row.peak_pressure_cells_low, nominal.peak_pressure_cells,
                                        row.peak_pressure_cells_high)},
      {"force_per_modulus_n", row.force_per_modulus}};
}

/// The band of a region, or of the whole hand without one; null if there is none.
Json band_or_null(const contact::ContactResult& contact, const contact::RegionContact* region) {
  if (!contact.band) return nullptr;
  const contact::ContactBand& band = *contact.band;
  const bool is_low = band.total.force_low > 0.0;
  const bool is_high = band.total.force_high > 0.0;
  if (region == nullptr) return band_object(band.total, contact.total, is_low, is_high);
  for (const contact::ContactBandRow& row : band.regions) {
    if (row.region == region->region) return band_object(row, *region, is_low, is_high);
  }
  return nullptr;
}

Json fallback_object(const contact::ContactFallbacks& fallbacks) {
  Json json = Json::object();
  for (const contact::FallbackCount& one : contact::kFallbackCounts) {
    json[std::string(one.name)] = fallbacks.*one.count;
  }
  return json;
}

/// Skin of the hand on its own skin, per pair of regions.
Json skin_on_skin_array(const contact::ContactResult& contact) {
  Json pairs = Json::array();
  for (const contact::SkinOnSkin& both : contact.skin_on_skin) {
    pairs.push_back({{"region", name_of(both.region)},
                     {"other_region", name_of(both.other)},
                     {"skin_on_skin_force_n", both.force},
                     {"force_vector_n", vector3(both.force_vector)},
                     {"contact_area_mm2", both.area},
                     {"peak_pressure_mpa", both.peak_pressure},
                     {"crossing_before_mm", both.deepest}});
  }
  return pairs;
}

Json refinement_or_null(const std::optional<contact::ContactRefinement>& refinement) {
  if (!refinement) return nullptr;
  return {{"halvings", refinement->levels},
          {"vertices_added", refinement->vertices},
          {"finest_edge_mm", refinement->finest_edge},
          {"last_change_of_peaks", refinement->peak_change},
          {"peak_pressure_cells_before_mpa", refinement->peak_before}};
}

/// Of the contact as it is shown: of a grasp that slips out, as the hand was closed.
Json contact_object(const contact::ContactResult& contact, double grip_force,
                    bool has_skin_on_skin) {
  Json json = {{"status", name_of_status(contact.status)},
               {"message", contact.message},
               {"grip_force_n", grip_force}};
  add_totals(json, contact.total);
  json["band"] = band_or_null(contact, nullptr);
  json["resolved"] = contact::is_resolved(contact);
  json["refinement"] = refinement_or_null(contact.refinement);
  json["complementarity_error_n_mm"] = contact.complementarity_error;
  json["residual_penetration_contact_mm"] = contact.residual_penetration_contact;
  json["residual_penetration_other_mm"] = contact.residual_penetration_other;
  if (has_skin_on_skin) {
    json["residual_crossing_mm"] = contact.residual_crossing;
    double by_skin = 0.0;
    for (const contact::SkinOnSkin& both : contact.skin_on_skin) by_skin += both.force;
    json["skin_on_skin_force_n"] = by_skin;
    json["skin_on_skin"] = skin_on_skin_array(contact);
  }
  json["iterations"] = contact.iterations;
  json["fallbacks"] = fallback_object(contact.fallbacks);
  Json regions = Json::array();
  for (const contact::RegionContact& region : contact.regions) {
    Json one = {{"region", name_of(region.region)}};
    add_totals(one, region);
    one["shear_modulus_mpa"] = region.shear_modulus;
    one["band"] = band_or_null(contact, &region);
    regions.push_back(std::move(one));
  }
  json["regions"] = std::move(regions);
  return json;
}

Json error_budget_object(const study::ErrorBudget& budget) {
  const auto figures = [](const study::ErrorCase& one) {
    return Json{{"grip_force_n", one.grip_force},
                {"force_n", one.force},
                {"contact_area_mm2", one.area},
                {"peak_pressure_mpa", one.peak_pressure},
                {"peak_pressure_cells_mpa", one.peak_pressure_cells},
                {"mean_pressure_mpa", one.mean_pressure}};
  };
  Json cases = Json::array();
  for (const study::ErrorCase& one : budget.cases) {
    Json entry = {{"source", name_of(one.source)}, {"changed", one.changed}};
    if (one.failure.empty()) {
      entry.update(figures(one));
    } else {
      entry["failure"] = one.failure;
    }
    cases.push_back(std::move(entry));
  }
  return {{"nominal", figures(budget.nominal)}, {"cases", std::move(cases)}};
}

Json face_array(const product::Product& product, const std::vector<study::FaceContact>& contacts) {
  Json faces = Json::array();
  for (const study::FaceContact& contact : contacts) {
    const product::ProductFace& face = product.faces->face[contact.face];
    faces.push_back({{"face", face.number},
                     {"title", product::title_of(face)},
                     {"name", face.name},
                     {"part", face.part},
                     {"kind", name_of(face.kind)},
                     {"is_fillet", face.is_fillet},
                     {"radius_mm", face.radius > 0.0 ? Json(face.radius) : Json(nullptr)},
                     {"area_mm2", face.area},
                     {"force_n", contact.force},
                     {"contact_area_mm2", contact.area},
                     {"peak_pressure_mpa", contact.peak_pressure},
                     {"mean_pressure_mpa", contact.mean_pressure},
                     {"has_peak", contact.has_peak}});
  }
  return faces;
}

Json wrench_object(const contact::Wrench& wrench) {
  return {{"force_n", vector3(wrench.force)}, {"moment_about_origin_n_mm", vector3(wrench.moment)}};
}

Json motion_object(const contact::SmallMotion& motion) {
  return {{"translation_mm", vector3(motion.translation)},
          {"rotation_deg", vector3(motion.rotation * geometry::kDegreesPerRadian)},
          {"about_mm", vector3(motion.about)}};
}

Json friction_object(const contact::FrictionResult& friction,
                     const contact::FrictionOptions& options) {
  const contact::ProductLoad& load = options.load;
  Json regions = Json::array();
  for (const contact::RegionFriction& region : friction.regions) {
    regions.push_back({{"region", name_of(region.region)},
                       {"normal_force_n", region.normal_force},
                       {"friction_limit_n", region.limit},
                       {"friction_force_n", vector3(region.force)},
                       {"slip_margin", region.margin},
                       {"slipping_share_of_area", region.slipping_share}});
  }
  Json given = {{"weight_n", load.weight},
                {"gravity", vector3(load.down())},
                {"force_n", vector3(load.force)},
                {"torque_n_mm", vector3(load.torque)},
                {"force_at_mm", vector3(load.force_at.value_or(friction.mass_centre))},
                {"mass_centre_mm", vector3(friction.mass_centre)},
                {"mass_centre_from", load.mass_centre ? "option" : "uniform density"}};
  return {{"status", name_of(friction.status)},
          {"message", friction.message},
          {"coefficient", options.coefficient},
          {"given", std::move(given)},
          {"load", wrench_object(friction.load)},
          {"load_factor", or_null(friction.load_factor)},
          {"slip_margin", friction.margin},
          {"slipping_share_of_area", friction.slipping_share},
          {"motion", motion_object(friction.motion)},
          {"slip_motion", motion_object(friction.slip)},
          {"pressure_on_product", wrench_object(friction.grip)},
          {"balance_error", friction.balance_error},
          {"iterations", friction.iterations},
          {"regions", std::move(regions)}};
}

Json balance_object(const grasp::Balance& balance) {
  if (balance.status == grasp::BalanceStatus::kOff) {
    return {{"status", name_of(balance.status)}, {"message", balance.message}};
  }
  return {{"status", name_of(balance.status)},
          {"message", balance.message},
          {"friction_coefficient", balance.friction},
          {"grip_force_n", balance.grip_force},
          {"sum_of_normal_forces_n", balance.sum_of_normals},
          {"turn_n_m", balance.turn ? Json(1e-3 * *balance.turn) : Json(nullptr)},
          {"residual_force_n", balance.residual_force},
          {"residual_moment_n_mm", balance.residual_moment},
          {"residual_over_grip_force", balance.residual_share},
          {"friction_in_use", balance.friction_use},
          {"flexion_strength_in_use", or_null(balance.strength_use)},
          {"moved_mm", balance.moved},
          {"turned_deg", balance.turned * geometry::kDegreesPerRadian},
          {"slip_direction_in_hand", balance.slip ? vector3(*balance.slip) : Json(nullptr)},
          {"iterations", balance.iterations},
          {"fallbacks", fallback_object(balance.fallbacks)}};
}

Json change_object(const study::FigureChange& change) {
  return {{"sum_of_normal_forces", change.force},
          {"area", change.area},
          {"peak_pressure_cells", change.peak_pressure_cells},
          {"mean_pressure", change.mean_pressure}};
}

/// How sure the figures are; null where nothing was looked for.
Json certainty_object(const std::optional<study::Certainty>& certainty) {
  if (!certainty) return nullptr;
  Json second = nullptr;
  if (certainty->second) {
    second = {{"change", change_object(certainty->second->change)},
              {"effort_over_first", certainty->second->effort}};
  }
  return {{"hand_1_percent_larger", change_object(certainty->hand_size)},
          {"force_1_percent_more", change_object(certainty->grip_force)},
          {"second_rest", std::move(second)}};
}

Json product_object(const product::Product& product) {
  Box3 box;
  for (const Vec3& v : product.mesh.vertices) box.extend(v);
  return {{"name", product.name},
          {"source", product.source},
          {"unit", name_of(product.unit)},
          {"unit_from", name_of(product.unit_source)},
          {"vertices", product.mesh.vertex_count()},
          {"triangles", product.mesh.triangle_count()},
          {"size_mm", vector3(box.isEmpty() ? Vec3::Zero() : Vec3(box.sizes()))},
          {"notes", product.notes}};
}

Json hand_object(const hand::Hand& hand) {
  return {{"name", hand.name},
          {"side", name_of(hand.side)},
          {"hand_length_mm", hand.dimensions.hand_length},
          {"hand_circumference_mm", hand.dimensions.hand_circumference},
          {"hand_width_mm", hand.dimensions.hand_width},
          {"hand_thickness_mm", hand.dimensions.hand_thickness},
          {"vertices", hand.skin.vertex_count()},
          {"triangles", hand.skin.triangle_count()},
          {"provenance", hand.provenance}};
}

/// Measures of the grasp as a whole.
Json indices_object(const contact::ContactResult& contact, const grasp::GraspIndices& indices) {
  std::set<hand::Finger> fingers;
  for (const contact::RegionContact& region : contact.regions) {
    const auto segment = hand::segment_of(region.region);
    const auto finger = segment ? hand::finger_of(*segment) : std::nullopt;
    if (finger) fingers.insert(*finger);
  }
  Json in_contact = Json::array();
  for (const hand::Finger finger : fingers) in_contact.push_back(name_of(finger));
  Json json = {{"fingers_in_contact", std::move(in_contact)},
               {"regions_in_contact", contact.regions.size()},
               {"net_force_n", contact.total.force_vector.norm()}};
  json.update(index_values(indices));
  return json;
}

Json coating_array(const std::vector<contact::Coating>& coatings) {
  Json array = Json::array();
  for (const contact::Coating& coating : coatings) {
    Json box = nullptr;  // the whole product
    if (!coating.where.isEmpty()) {
      box = {vector3(coating.where.min()), vector3(coating.where.max())};
    }
    array.push_back({{"thickness_mm", coating.thickness},
                     {"shear_modulus_mpa", coating.shear_modulus},
                     {"poisson", coating.poisson},
                     {"box_corners_mm", std::move(box)}});
  }
  return array;
}

Json doubts_array(const study::Assessment& assessment) {
  Json doubts = Json::array();
  for (const study::HoldDoubt& one : study::doubts_of(assessment)) {
    doubts.push_back({{"key", one.key}, {"words", one.words}});
  }
  return doubts;
}

Json settings_object(const study::Assessment& assessment) {
  const study::AssessOptions& options = assessment.options;
  const grasp::PlacementRequest& placed = options.grasp.power.placement;
  return {
      {"palm_limit_depth_mm", options.grasp.power.palm_limit_depth},
      {"finger_limit_depth_mm", options.grasp.power.finger_limit_depth},
      {"at_mm", placed.at ? vector3(*placed.at) : Json(nullptr)},
      {"axis", placed.axis ? vector3(*placed.axis) : Json(nullptr)},
      {"turn_deg", placed.turn ? Json(*placed.turn * geometry::kDegreesPerRadian) : Json(nullptr)},
      {"balance", options.balance.is_on},
      {"balance_friction", options.balance.friction},
      {"grip_force_asked_n", or_null(options.balance.asked_grip_force(assessment.grasp.grip))},
      {"grip_force_from", options.balance.asked_words(assessment.grasp.grip)},
      {"contact_model", name_of(assessment.contact.model)},
      {"kernel", name_of(assessment.contact.model.kernel)},
      {"tissue_model", name_of(assessment.contact.model.tissue)},
      {"regions", name_of(assessment.contact.model.coupling)},
      {"swelling", options.contact.swelling},
      {"skin_on_skin", options.contact.skin_on_skin},
      {"refine", options.contact.refine},
      {"coatings", coating_array(options.contact.coatings)},
      {"error_band", options.contact.error_band},
      {"cell_area_mm2", options.contact.cell_area},
      {"shear_modulus_mpa", or_null(options.contact.shear_modulus)},
      {"seed", options.seed}};
}

}  // namespace

std::string grasp_json(const grasp::Grasp& grasp) {
  Json json = grasp_object(grasp);
  json["hold"] = hold_object(grasp);
  return json_file_text(json);
}

std::string placements_json(const grasp::Grasp& grasp) {
  Json list = Json::array();
  list.push_back(
      runner_up_object({grasp.grip, grasp.posture, grasp.product_from_hand, grasp.score}));
  for (const grasp::GraspRunnerUp& other : grasp.runners_up)
    list.push_back(runner_up_object(other));
  return json_file_text({{"status", name_of(grasp.status)},
                         {"message", grasp.message},
                         {"candidates", grasp.candidates},
                         {"placements", std::move(list)}});
}

bool is_assessment_json(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  return json.is_object() && json.contains("assessments") && json.contains("versions") &&
         json["versions"].is_object() && json["versions"].contains("palmar");
}

std::string assessment_json(const study::AssessmentSet& set, const VerdictWords& words) {
  Json assessments = Json::array();
  const study::SetVerdict verdict = study::verdict_of(set);
  std::vector<std::string> names;
  for (const study::AssessedProduct& one : set.assessments) {
    const std::size_t number = names.size();
    names.push_back(one.product.name);
    const study::Assessment& assessment = one.assessment;
    Json hand = set.hand ? hand_object(*set.hand) : Json{{"name", assessment.hand_name}};
    Json entry = {{"product", product_object(one.product)},
                  {"hand", std::move(hand)},
                  {"hold", hold_object(assessment.grasp)},
                  {"doubts", doubts_array(assessment)},
                  {"grasp", grasp_object(assessment.grasp)},
                  {"balance", balance_object(assessment.balance)},
                  {"certainty", certainty_object(assessment.certainty)},
                  {"contact", contact_object(assessment.contact, study::grip_force_of(one),
                                             assessment.options.contact.skin_on_skin)},
                  {"verdict", verdict_object(one, verdict.products[number],
                                             number < words.products.size() ? words.products[number]
                                                                            : ProductWords{})},
                  {"indices", indices_object(assessment.contact, assessment.indices)},
                  {"index_table", index_rows(assessment.indices)},
                  {"settings", settings_object(assessment)}};
    if (assessment.sensors) entry["sensors"] = sensor_object(assessment);
    if (one.errors) entry["error_budget"] = error_budget_object(*one.errors);
    if (one.product.faces != nullptr) entry["faces"] = face_array(one.product, assessment.faces);
    if (assessment.options.friction.is_on()) {
      entry["friction"] = friction_object(assessment.friction, assessment.options.friction);
    }
    assessments.push_back(std::move(entry));
  }
  const Json json = {{"assessments", std::move(assessments)},
                     {"verdict", verdict_object(verdict, words, names)},
                     {"versions", {{"palmar", version()}, {"build", build_description()}}},
                     {"command_line", set.command_line}};
  return json_file_text(json);
}

}  // namespace palmar::records
