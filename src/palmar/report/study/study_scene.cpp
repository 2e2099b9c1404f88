// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/study_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/report/picture/display_mesh.h"
#include "palmar/report/picture/packed_field.h"
#include "palmar/report/study/face_words.h"
#include "palmar/report/words/phrases.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/report/words/study_words.h"
#include "palmar/study/statistics/study_statistics.h"

namespace palmar::report {
namespace {

constexpr int kMostTrianglesEach = 40000;
constexpr double kShownReach = 30.0;  // mm; deeper inside nothing is brought to the surface
constexpr double kThesisEnd = 0.7;    // MPa; colour scale of Xie 2014, fig. 5-12

std::size_t place(int i) { return static_cast<std::size_t>(i); }

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + "\"";
}

std::vector<double> unpacked(const study::SparseField& field, std::size_t size) {
  std::vector<double> result(size, 0.0);
  for (std::size_t i = 0; i < field.vertex.size(); ++i) {
    if (field.vertex[i] < 0 || place(field.vertex[i]) >= size) {
      throw UsageError("report: a pressure field names vertex " + std::to_string(field.vertex[i]) +
                       " of a mesh of " + std::to_string(size));
    }
    result[place(field.vertex[i])] = field.value[i];
  }
  return result;
}

/// A product as it is shown: its map, coarser if it is very fine.
struct ShownProduct {
  geometry::TriangleMesh map;
  std::vector<int> face_of_triangle;  ///< of `map`
  DisplayMesh shown;
  std::vector<double> shown_field(const std::vector<double>& field) const {
    return display_mesh(map, field, kMostTrianglesEach).value;
  }
};

ShownProduct shown_product(const product::Product& product) {
  ShownProduct one;
  study::ProductMap map = study::product_map(product);
  one.map = std::move(map.mesh);
  one.face_of_triangle = std::move(map.face_of_triangle);
  one.shown =
      display_mesh(one.map, std::vector<double>(one.map.vertices.size()), kMostTrianglesEach);
  return one;
}

/// A grasp of the view; with `skin` if the product was in the hand.
std::string grasp_json(const StudySceneInput& input, const study::StudyRecord& record,
                       const hand::Hand& hand, const std::vector<ShownProduct>& products,
                       int shown_hand, const Phrases& phrases) {
  const study::StudyTask task = study::task_at(input.results.plan, record.number);
  std::string json = "{\"hand\":" + std::to_string(shown_hand) +
                     ",\"product\":" + std::to_string(task.product) +
                     ",\"says\":" + quoted(phrases(grasp_words(record)));
  if (study::is_in_hand(record)) {
    const product::Product& product = input.inputs.products[place(task.product)];
    const ShownProduct& shown = products[place(task.product)];
    const double upper = input.scales.grasp.upper;
    json += ",\"skin\":" + packed_positions(displayed_skin(hand, record, product)) +
            ",\"pressure\":\"" +
            packed_shares(unpacked(record.skin_pressure, hand.skin.vertices.size()), upper) +
            "\",\"onProduct\":\"" +
            packed_shares(
                shown.shown_field(unpacked(record.product_pressure, shown.map.vertices.size())),
                upper) +
            "\"";
  }
  return json + "}";
}

/// What the view says and draws of a product's faces; "null" if it has none.
std::string faces_json(const StudySceneInput& input, int product, const ShownProduct& shown,
                       const Phrases& phrases) {
  const product::Product& given = input.inputs.products[place(product)];
  if (given.faces == nullptr) return "null";
  std::vector<const study::FaceSummary*> summary(given.faces->face.size(), nullptr);
  for (const study::FaceStatistics& one : input.faces) {
    if (one.product != product || !study::is_same(one.condition, input.condition)) continue;
    for (const study::FaceSummary& face : one.faces) summary[place(face.face)] = &face;
  }
  std::vector<Vec3> borders;
  for (const auto& edge : product::border_edges(given.mesh, given.faces->face_of_triangle)) {
    for (const int v : edge) borders.push_back(given.mesh.vertices[place(v)]);
  }
  std::string says;
  for (std::size_t f = 0; f < summary.size(); ++f) {
    says += (f > 0 ? "," : "") + quoted(phrases(face_words(given.faces->face[f], summary[f])));
  }
  // A coarser mesh has other triangles than the map.
  const bool is_whole = shown.shown.mesh.triangles.size() == shown.face_of_triangle.size();
  return "{\"ends\":" + std::to_string(borders.size()) +
         ",\"borders\":" + packed_positions(borders) + ",\"ofTriangle\":" +
         (is_whole ? "\"" + packed_numbers(shown.face_of_triangle) + "\"" : "null") +
         ",\"says\":[" + says + "]}";
}

std::string map_json(const study::PressureMap& skin, const study::PressureMap& product,
                     const ShownProduct& shown, const StudyScales& scales) {
  const auto pair = [&](const char* key, const std::vector<double>& on_skin,
                        const std::vector<double>& on_product, double upper) {
    return std::string("\"") + key + "\":{\"skin\":\"" + packed_shares(on_skin, upper) +
           "\",\"product\":\"" + packed_shares(shown.shown_field(on_product), upper) + "\"}";
  };
  const auto per_cent = [](std::vector<double> share) {
    for (double& one : share) one *= 100.0;
    return share;
  };
  return "{" + pair("mean", skin.mean, product.mean, scales.mean.upper) + "," +
         pair("sd", skin.sd, product.sd, scales.sd.upper) + "," +
         pair("above", per_cent(skin.above), per_cent(product.above), scales.above.upper) + "}";
}

/// What is shown of one hand.
struct GraspsOfHand {
  std::vector<const study::StudyRecord*> records;
  std::vector<std::string> grasps;
};

}  // namespace

StudyScales study_scales(const study::StudyResults& results,
                         const std::vector<study::StudyMaps>& maps) {
  std::vector<double> peaks;
  for (const study::StudyRecord& record : results.records) {
    if (study::is_in_hand(record)) peaks.push_back(record.peak_pressure_cells);
  }
  std::sort(peaks.begin(), peaks.end());
  const double high = peaks.empty() ? 0.0 : statistics::quantile(peaks, 0.95);
  const bool thesis_fits = high >= 0.3 && high <= 0.8;
  double mean = 0.0, sd = 0.0;
  for (const study::StudyMaps& one : maps) {
    for (const study::PressureMap* map : {&one.skin, &one.on_product}) {
      for (const double value : map->mean) mean = std::max(mean, value);
      for (const double value : map->sd) sd = std::max(sd, value);
    }
  }
  const auto scale = [](const char* quantity, double upper) {
    return ColourScale{
        Colormap::kEmber, upper > 0.0 ? upper : 0.1, quantity, "MPa", kNeutralColour, false};
  };
  StudyScales scales;
  scales.grasp = scale("Pressure", thesis_fits ? kThesisEnd : high > 0.0 ? rounded_up(high) : 0.1);
  scales.grasp.is_open_ended = !peaks.empty();  // single vertices lie above the cells' peaks
  scales.mean = scale("Mean pressure", mean > 0.0 ? rounded_up(mean) : 0.1);
  scales.sd = scale("SD of pressure", sd > 0.0 ? rounded_up(sd) : 0.1);
  scales.above = {Colormap::kFern, 100.0, "Share of hands", "%", kNeutralColour, false};
  return scales;
}

std::vector<int> shown_hands(const study::StudyPlan& plan, const study::StudyCondition& condition,
                             int most_grasps) {
  std::vector<int> hands = study::hands_of(plan, condition);
  const auto products = std::max<std::size_t>(1, plan.products.size());
  const std::size_t most = std::max<std::size_t>(1, place(std::max(0, most_grasps)) / products);
  if (hands.size() <= most) return hands;
  std::stable_sort(hands.begin(), hands.end(), [&](int a, int b) {
    return study::size_of(plan.hands[place(a)], study::kHandLength).value_or(0.0) <
           study::size_of(plan.hands[place(b)], study::kHandLength).value_or(0.0);
  });
  std::vector<int> chosen;
  for (std::size_t k = 0; k < most; ++k) {
    const double share = most == 1 ? 0.5 : static_cast<double>(k) / static_cast<double>(most - 1);
    chosen.push_back(hands[static_cast<std::size_t>(
        std::lround(share * static_cast<double>(hands.size() - 1)))]);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

int typical_hand(const study::StudyPlan& plan, const std::vector<int>& hands) {
  if (hands.empty()) throw UsageError("report: no hand to choose from");
  std::vector<double> far(hands.size(), 0.0);
  for (const hand::HandDimension dimension : {study::kHandLength, study::kHandCircumference}) {
    std::vector<double> sizes;
    for (const int h : hands) {
      if (const auto size = study::size_of(plan.hands[place(h)], dimension)) sizes.push_back(*size);
    }
    if (sizes.size() != hands.size()) continue;
    const statistics::Summary summary = statistics::summarise(sizes);
    if (!(summary.sd > 0.0)) continue;
    for (std::size_t i = 0; i < hands.size(); ++i) {
      far[i] += std::pow((sizes[i] - summary.mean) / summary.sd, 2);
    }
  }
  return hands[static_cast<std::size_t>(std::min_element(far.begin(), far.end()) - far.begin())];
}

std::vector<Vec3> displayed_skin(const hand::Hand& hand, const study::StudyRecord& record,
                                 const product::Product& product) {
  std::vector<Vec3> skin = hand::pose_skin(hand, record.posture);
  for (Vec3& v : skin) v = record.product_from_hand * v;
  std::vector<geometry::DistanceSample> samples(skin.size());
  product.distance->sample(skin, kShownReach, samples);
  for (std::size_t i = 0; i < skin.size(); ++i) {
    const geometry::DistanceSample& sample = samples[i];
    if (sample.distance >= 0.0 || sample.distance <= -kShownReach) continue;
    // Along the gradient, not to the closest point: that may be on a thin product's far side.
    skin[i] -= sample.distance * sample.normal;
  }
  return skin;
}

std::string study_scene_json(const StudySceneInput& input) {
  const study::StudyPlan& plan = input.results.plan;
  if (input.inputs.products.size() != plan.products.size() ||
      input.maps.size() != plan.products.size()) {
    throw UsageError("report: " + std::to_string(input.inputs.products.size()) + " products and " +
                     std::to_string(input.maps.size()) + " maps for a plan of " +
                     std::to_string(plan.products.size()) + " products");
  }
  const hand::Hand& base = *input.inputs.base;
  const Phrases phrases(input.language);
  std::vector<ShownProduct> products(plan.products.size());
  parallel_for(static_cast<int>(products.size()),
               [&](int p) { products[place(p)] = shown_product(input.inputs.products[place(p)]); });

  const std::vector<int> hands = shown_hands(plan, input.condition, input.most_grasps);
  std::vector<study::StudyRecord> records;
  input.records([&](const study::StudyRecord& record) {
    const study::StudyTask task = study::task_at(plan, record.number);
    if (task.profile == input.condition.profile && task.setting == input.condition.setting &&
        task.grip == input.condition.grip &&
        std::binary_search(hands.begin(), hands.end(), task.hand)) {
      records.push_back(record);
    }
  });
  std::vector<GraspsOfHand> parts(hands.size());
  for (const study::StudyRecord& record : records) {
    const auto place =
        std::lower_bound(hands.begin(), hands.end(), study::task_at(plan, record.number).hand);
    parts[static_cast<std::size_t>(place - hands.begin())].records.push_back(&record);
  }
  parallel_for(static_cast<int>(parts.size()), [&](int i) {
    GraspsOfHand& part = parts[place(i)];
    std::optional<hand::Hand> hand;
    for (const study::StudyRecord* record : part.records) {
      if (!hand && study::is_in_hand(*record))
        hand = input.hand_of(study::task_at(plan, record->number));
      part.grasps.push_back(grasp_json(input, *record, hand ? *hand : base, products, i, phrases));
    }
  });

  std::string table;
  std::string fern;
  for (const Rgb c : colour_table(input.scales.grasp.map)) {
    for (const std::uint8_t byte : {c.r, c.g, c.b}) table += static_cast<char>(byte);
  }
  for (const Rgb c : colour_table(input.scales.above.map)) {
    for (const std::uint8_t byte : {c.r, c.g, c.b}) fern += static_cast<char>(byte);
  }
  std::string json = "{\"table\":\"" + formats::base64(table) + "\",\"shareTable\":\"" +
                     formats::base64(fern) + "\",\"neutral\":" + json_triple(kNeutralColour) +
                     ",\"skinColour\":" + json_triple(kSkinColour) +
                     ",\"productColour\":" + json_triple(kProductColour) +
                     ",\"vertices\":" + std::to_string(base.skin.vertices.size()) +
                     ",\"triangles\":\"" + packed_triangles(base.skin.triangles) +
                     "\",\"open\":" + packed_positions(base.skin.vertices) + ",\"hands\":[";
  for (std::size_t i = 0; i < hands.size(); ++i) {
    json += (i > 0 ? "," : "") + quoted(phrases(hand_words(plan, input.condition, hands[i])));
  }
  json += "],\"products\":[";
  const double radial = base.side == hand::Side::kLeft ? -1.0 : 1.0;
  for (std::size_t p = 0; p < products.size(); ++p) {
    // Seen as the typical hand holds it; the maps are shown on that hand, too.
    std::vector<int> holding;
    for (const int h : hands) {
      const study::StudyRecord* record =
          study::record_of(input.results, input.condition, static_cast<int>(p), h);
      if (record != nullptr && study::is_in_hand(*record)) holding.push_back(h);
    }
    int typical = -1;
    Quat rotation = Quat::Identity();
    if (!holding.empty()) {
      const int hand = typical_hand(plan, holding);
      rotation = study::record_of(input.results, input.condition, static_cast<int>(p), hand)
                     ->product_from_hand.rotation;
      typical =
          static_cast<int>(std::lower_bound(hands.begin(), hands.end(), hand) - hands.begin());
    }
    const ShownProduct& one = products[p];
    json += (p > 0 ? "," : "") + std::string("{\"name\":") + quoted(plan.products[p].name) +
            ",\"vertices\":" + std::to_string(one.shown.mesh.vertices.size()) +
            ",\"triangles\":\"" + packed_triangles(one.shown.mesh.triangles) +
            "\",\"places\":" + packed_positions(one.shown.mesh.vertices) +
            ",\"palmward\":" + json_triple(rotation * Vec3::UnitZ()) +
            ",\"distal\":" + json_triple(rotation * Vec3::UnitY()) +
            ",\"radial\":" + json_triple(rotation * (radial * Vec3::UnitX())) +
            ",\"typical\":" + std::to_string(typical) +
            ",\"held\":" + std::to_string(input.maps[p].hands) +
            ",\"faces\":" + faces_json(input, static_cast<int>(p), one, phrases) + ",\"maps\":" +
            map_json(input.maps[p].skin, input.maps[p].on_product, one, input.scales) + "}";
  }
  json += "],\"grasps\":[";
  bool is_first = true;
  for (const GraspsOfHand& part : parts) {
    for (const std::string& grasp : part.grasps) {
      json += (is_first ? "" : ",") + grasp;
      is_first = false;
    }
  }
  return json + "]}";
}

}  // namespace palmar::report
