// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hold/hold_json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "palmar/geometry/degrees.h"
#include "palmar/records/json_values.h"
#include "palmar/records/posture/placement_json.h"

namespace palmar::records {
namespace {

using HoldJson = nlohmann::ordered_json;

constexpr std::size_t kMostStations = 32;  // of a part's line
constexpr double kAlongAxis =
    20.0 * geometry::kDegree;  // a direction so near an axis is called by it

HoldJson terms_array(const std::vector<grasp::HoldTerm>& terms) {
  HoldJson array = HoldJson::array();
  for (const grasp::HoldTerm& term : terms) {
    array.push_back({{"name", term.name},
                     {"value", finite_or_null(term.value)},
                     {"unit", term.unit},
                     {"score", finite_or_null(term.score)},
                     {"words", term.words}});
  }
  return array;
}

HoldJson plain_hold(const grasp::Hold& hold, const std::optional<product::PartKind>& kind,
                    const std::string& words) {
  HoldJson json = {{"part", hold.part},
                   {"part_name", hold.part_name},
                   {"kind", kind ? HoldJson(name_of(*kind)) : HoldJson(nullptr)},
                   {"grip", name_of(hold.grip)},
                   {"along", hold.along},
                   {"edge", hold.edge},
                   {"toward", hold.toward},
                   {"turn_deg", hold.turn * geometry::kDegreesPerRadian},
                   {"over_end", hold.is_over_end},
                   {"words", words}};
  if (hold.anchor) {
    json["along_toward"] = vector3(hold.anchor->along);
    json["turn_from"] = vector3(hold.anchor->zero);
  }
  if (hold.fingertips.empty()) return json;
  HoldJson tips = HoldJson::array();
  for (const grasp::HoldFingertip& tip : hold.fingertips) {
    tips.push_back({{"finger", name_of(tip.finger)},
                    {"along", tip.place.along},
                    {"turn_deg", tip.place.turn * geometry::kDegreesPerRadian},
                    {"height_mm", tip.place.height}});
  }
  json["fingertips"] = std::move(tips);
  if (hold.wrist) json["wrist"] = vector3(*hold.wrist);
  return json;
}

std::optional<product::PartKind> kind_of_part(int number, const product::ProductParts& parts) {
  for (const product::ProductPart& part : parts.parts) {
    if (part.number == number) return part.kind;
  }
  return std::nullopt;
}

}  // namespace

Vec3 thumb_direction(const grasp::Grasp& grasp, hand::Side side) {
  return grasp.product_from_hand.rotation * Vec3(side == hand::Side::kLeft ? -1.0 : 1.0, 0.0, 0.0);
}

std::string direction_words(const Vec3& direction) {
  const Vec3 unit = direction.normalized();
  int axis = 0;
  unit.cwiseAbs().maxCoeff(&axis);
  if (std::abs(unit[axis]) >= std::cos(kAlongAxis)) {
    return fmt::format("{}{}", unit[axis] < 0.0 ? '-' : '+', "xyz"[axis]);
  }
  const auto digit = [](double x) { return std::round(10.0 * x) / 10.0 + 0.0; };  // no -0
  return fmt::format("({:g}, {:g}, {:g})", digit(unit.x()), digit(unit.y()), digit(unit.z()));
}

HoldJson hold_object(const grasp::Grasp& grasp) {
  if (!grasp.hold) return nullptr;
  HoldJson json = plain_hold(*grasp.hold, grasp.hold_kind, grasp.hold_words);
  if (grasp.hold_terms.empty()) return json;
  double score = 0.0;
  for (const grasp::HoldTerm& term : grasp.hold_terms) score += term.score;
  json["score"] = finite_or_null(score);
  json["terms"] = terms_array(grasp.hold_terms);
  return json;
}

std::string ranked_holds_json(const grasp::RankedHolds& ranked, const std::string& product,
                              hand::Side side) {
  HoldJson parts = HoldJson::array();
  const auto rounded = [](const Vec3& v) {
    HoldJson place = HoldJson::array();
    for (int k = 0; k < 3; ++k) place.push_back(std::round(1000.0 * v[k]) / 1000.0 + 0.0);
    return place;
  };
  for (const product::ProductPart& part : ranked.parts.parts) {
    HoldJson line = HoldJson::array();
    const std::size_t step = 1 + part.line.size() / kMostStations;
    for (std::size_t k = 0; k < part.line.size(); k += step) {
      const product::PartStation& station = part.line[k];
      line.push_back({{"along", station.along},
                      {"centre_mm", rounded(station.centre)},
                      {"axis", rounded(station.axis)}});
    }
    parts.push_back({{"number", part.number},
                     {"kind", name_of(part.kind)},
                     {"name", part.name},
                     {"length_mm", part.length},
                     {"girth_mm", part.girth},
                     {"line", std::move(line)}});
  }
  HoldJson holds = HoldJson::array();
  for (const grasp::RankedHold& one : ranked.holds) {
    HoldJson json = {{"number", holds.size() + 1}};
    json.update(plain_hold(one.hold, kind_of_part(one.hold.part, ranked.parts), one.words));
    json["thumb_towards"] = vector3(thumb_direction(one.grasp, side));
    json["score"] = finite_or_null(one.score);
    json["terms"] = terms_array(one.terms);
    json["against"] = one.against;
    json["product_from_hand"] = placement_with_matrix(one.grasp.product_from_hand);
    holds.push_back(std::move(json));
  }
  const HoldJson json = {{"product", product},
                         {"parts", std::move(parts)},
                         {"considered", ranked.considered},
                         {"closed", ranked.closed},
                         {"holds", std::move(holds)}};
  return json.dump(2, ' ', false, HoldJson::error_handler_t::replace);
}

}  // namespace palmar::records
