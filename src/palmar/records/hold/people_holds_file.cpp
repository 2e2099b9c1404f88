// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hold/people_holds_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/formats/csv_reader.h"
#include "palmar/formats/file.h"
#include "palmar/formats/toml_section.h"
#include "palmar/records/json_values.h"

namespace palmar::records {
namespace {

constexpr double kFarthest = 5000.0;  // mm from the object's origin; farther is another unit
constexpr double kLargest = 1e6;      // of a weight, mean or spread
constexpr std::uint64_t kMostBytes = 1 << 16;

std::string point_name(std::size_t k) {
  return k == 0 ? "wrist" : std::string(name_of(static_cast<hand::Finger>(k - 1)));
}

grasp::HoldFeature feature_at(int k) { return static_cast<grasp::HoldFeature>(k); }

}  // namespace

std::vector<PeopleHolds> read_people_holds(const std::string& path) {
  const formats::CsvFile file = formats::read_csv(path);
  const auto column = [&](const std::string& name) {
    const int found = file.column(name);
    if (found < 0) {
      file.fail(
          file.header_line,
          fmt::format("there is no column \"{}\"; object and wrist_x_mm, wrist_y_mm, "
                      "wrist_z_mm, thumb_x_mm ... little_z_mm, up_x, up_y and up_z are required",
                      name));
    }
    return static_cast<std::size_t>(found);
  };
  const std::size_t object = column("object");
  std::array<std::array<std::size_t, 3>, grasp::HandPoints::kCount> columns{};
  for (std::size_t k = 0; k < columns.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      columns[k][c] = column(fmt::format("{}_{}_mm", point_name(k), "xyz"[c]));
    }
  }
  std::array<std::size_t, 3> up{};
  for (std::size_t c = 0; c < 3; ++c) up[c] = column(fmt::format("up_{}", "xyz"[c]));
  std::vector<PeopleHolds> result;
  for (const formats::CsvFile::Row& row : file.rows) {
    const std::string& name = row.cells[object];
    if (name.empty()) file.fail(row.line, "object is empty; the name of its mesh is required");
    auto known = std::find_if(result.begin(), result.end(),
                              [&](const PeopleHolds& one) { return one.object == name; });
    if (known == result.end()) known = result.insert(result.end(), {name, {}});
    PeopleHold& hold = known->holds.emplace_back();
    for (std::size_t k = 0; k < columns.size(); ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = file.number(row, columns[k][c]);
        if (std::abs(value) > kFarthest) {
          file.fail(row.line, fmt::format("{} is {:g} mm; {:g} mm at most is allowed",
                                          file.header[columns[k][c]], value, kFarthest));
        }
        hold.points.point[k][static_cast<Eigen::Index>(c)] = value;
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      hold.up[static_cast<Eigen::Index>(c)] = file.number(row, up[c]);
    }
    if (!(hold.up.norm() > 0.0 && hold.up.norm() < kLargest)) {
      file.fail(row.line,
                "up_x, up_y and up_z have no direction; three numbers, not all 0, are "
                "required");
    }
    hold.up.normalize();
  }
  if (result.empty()) throw InputError(path + ": it has no holds below the header");
  return result;
}

std::string hold_weights_toml(const grasp::HoldWeights& weights) {
  std::string text =
      "# How likely people are to take a hold, by what is seen of it: palmar grasp fit-holds.\n"
      "# docs/method/hand-over.md says what the features are. A hold's score is the sum of\n"
      "# weight (feature - mean) / spread, with weight_unseen where nobody says how the\n"
      "# product lies.\n";
  for (int k = 0; k < grasp::kHoldFeatureCount; ++k) {
    text += fmt::format(
        "\n[{}]\nweight = {}\nweight_unseen = {}\nmean = {}\nspread = {}\n", name_of(feature_at(k)),
        formats::toml_number(weights.weight[k]), formats::toml_number(weights.unseen[k]),
        formats::toml_number(weights.mean[k]), formats::toml_number(weights.spread[k]));
  }
  return text;
}

grasp::HoldWeights read_hold_weights(const std::string& path) {
  const toml::table table = formats::parse_toml(formats::read_file(path, kMostBytes), path);
  const formats::TomlSection file(path, "", table);
  std::vector<std::string> known;
  for (int k = 0; k < grasp::kHoldFeatureCount; ++k) known.emplace_back(name_of(feature_at(k)));
  file.allow(known);
  grasp::HoldWeights weights;
  for (int k = 0; k < grasp::kHoldFeatureCount; ++k) {
    const std::string& name = known[static_cast<std::size_t>(k)];
    const std::optional<formats::TomlSection> section = file.table(name);
    if (!section) file.fail("table [" + name + "] is missing; one for each feature is required");
    section->allow({"weight", "weight_unseen", "mean", "spread"});
    weights.unseen[k] = section->need_number("weight_unseen", "", -kLargest, kLargest);
    weights.weight[k] = section->need_number("weight", "", -kLargest, kLargest);
    weights.mean[k] = section->need_number("mean", "", -kLargest, kLargest);
    weights.spread[k] = section->need_number("spread", "", 1e-9, kLargest);
  }
  return weights;
}

std::string hold_fit_json(const grasp::HoldFit& fit) {
  nlohmann::ordered_json json;
  for (int k = 0; k < grasp::kHoldFeatureCount; ++k) {
    json["features"].push_back({{"feature", name_of(feature_at(k))},
                                {"weight", fit.weights.weight[k]},
                                {"weight_unseen", fit.weights.unseen[k]},
                                {"mean", fit.weights.mean[k]},
                                {"spread", fit.weights.spread[k]}});
  }
  json["log_likelihood_per_hold"] = fit.likelihood;
  for (const grasp::LeftOut& one : fit.left_out) {
    json["left_out"].push_back({{"object", one.name},
                                {"holds", one.seen},
                                {"nearest_candidate_mm", one.nearest},
                                {"log_likelihood_per_hold", one.likelihood},
                                {"log_likelihood_not_knowing_how_it_lay", one.unseen},
                                {"log_likelihood_of_even_chances", one.even},
                                {"first_hold_mm", one.first},
                                {"best_of_eight_mm", one.best_of_eight}});
  }
  return json_file_text(json);
}

}  // namespace palmar::records
