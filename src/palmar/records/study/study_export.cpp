// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_export.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <map>
#include <memory>
#include <set>
#include <system_error>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/degrees.h"
#include "palmar/population/sex_names.h"
#include "palmar/records/csv.h"
#include "palmar/records/study/study_plan_json.h"
#include "palmar/study/assessment/grasp_indices.h"

namespace palmar::records {
namespace {

namespace fs = std::filesystem;

/// A CSV file that is written line by line and has its name once it is whole.
class CsvWriter {
 public:
  CsvWriter(fs::path path, std::vector<std::string> header)
      : path_(std::move(path)), draft_(path_.string() + ".part"), columns_(header.size()) {
    file_ = std::fopen(draft_.c_str(), "wb");
    if (file_ == nullptr) fail();
    add(std::move(header));
  }
  ~CsvWriter() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    std::remove(draft_.c_str());
  }
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  void add(std::vector<std::string> cells) {
    if (cells.size() != columns_) throw OutputError(path_.string() + ": a row of another length");
    const std::string text = format_csv({std::move(cells), {}});
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail();
  }
  fs::path finish() {
    const bool is_flushed = std::fflush(file_) == 0;
    const bool is_closed = std::fclose(file_) == 0;
    file_ = nullptr;
    if (!is_flushed || !is_closed) fail();
    std::error_code error;
    fs::rename(draft_, path_, error);
    if (error) throw OutputError(path_.string() + ": can't be written: " + error.message());
    return path_;
  }

 private:
  [[noreturn]] void fail() const {
    const std::string reason = std::generic_category().message(errno);
    std::remove(draft_.c_str());
    throw OutputError(path_.string() + ": can't be written: " + reason);
  }

  fs::path path_, draft_;
  std::size_t columns_;
  std::FILE* file_ = nullptr;
};

std::string optional_cell(const std::optional<double>& value) {
  return value ? formats::shortest(*value) : "";
}

fs::path write_hands(const study::StudyPlan& plan, const fs::path& folder) {
  std::set<hand::HandDimension> given;
  for (const study::StudyHand& hand : plan.hands) {
    for (const hand::SizedDimension& one : hand.sample.dimensions) given.insert(one.dimension);
  }
  std::vector<hand::HandDimension> columns;
  std::vector<std::string> header = {"hand", "population", "label",          "stratum",
                                     "sex",  "age_years",  "grip_strength_n"};
  for (const hand::HandDimension dimension : hand::all_hand_dimensions()) {
    if (given.count(dimension) == 0) continue;
    columns.push_back(dimension);
    header.push_back(name_of(dimension) + "_mm");
  }
  CsvWriter file(folder / "hands.csv", header);
  for (std::size_t h = 0; h < plan.hands.size(); ++h) {
    const study::StudyHand& hand = plan.hands[h];
    const population::HandSample& sample = hand.sample;
    std::vector<std::string> row = {
        std::to_string(h),
        plan.populations[hand.population].population.name,
        sample.label,
        sample.stratum,
        sample.sex ? population::name_of(*sample.sex) : "",
        optional_cell(sample.age),
        sample.grip_strength > 0.0 ? formats::shortest(sample.grip_strength) : ""};
    for (const hand::HandDimension dimension : columns) {
      const auto found =
          std::find_if(sample.dimensions.begin(), sample.dimensions.end(),
                       [&](const hand::SizedDimension& one) { return one.dimension == dimension; });
      row.push_back(found == sample.dimensions.end() ? "" : formats::shortest(found->value));
    }
    file.add(std::move(row));
  }
  return file.finish();
}

fs::path write_products(const study::StudyPlan& plan, const fs::path& folder) {
  CsvWriter file(folder / "products.csv", {"product", "name", "family", "size", "file",
                                           "content_sha256", "mass_kg", "posture_of"});
  for (std::size_t i = 0; i < plan.products.size(); ++i) {
    const study::StudyProduct& one = plan.products[i];
    file.add({std::to_string(i), one.name, one.family, formats::shortest(one.size), one.file,
              one.content_hash, formats::shortest(one.mass), one.posture_of});
  }
  return file.finish();
}

fs::path write_profiles(const study::StudyPlan& plan, const fs::path& folder) {
  CsvWriter file(folder / "profiles.csv",
                 {"profile", "name", "range_share", "strength_share", "glove_thickness_mm",
                  "glove_shear_modulus_mpa", "nail_length_mm", "size_factor", "source"});
  for (std::size_t i = 0; i < plan.profiles.size(); ++i) {
    const population::HandProfile& one = plan.profiles[i];
    file.add({std::to_string(i), one.name, formats::shortest(one.range_share),
              formats::shortest(one.strength_share), formats::shortest(one.glove_thickness),
              formats::shortest(one.glove_shear_modulus), formats::shortest(one.nail_length),
              formats::shortest(one.size_factor), one.source});
  }
  return file.finish();
}

fs::path write_settings(const study::StudyPlan& plan, const fs::path& folder) {
  CsvWriter file(folder / "settings.csv",
                 {"setting", "name", "task", "turn_n_m", "grip_force_n", "strength_share",
                  "strength_n", "least_grip_force_n", "limit_depths", "palm_limit_depth_mm",
                  "finger_limit_depth_mm", "friction", "is_balanced", "equations", "indices",
                  "wrench_volume", "torque", "refine", "place"});
  for (std::size_t i = 0; i < plan.settings.size(); ++i) {
    const study::StudySetting& one = plan.settings[i];
    file.add({std::to_string(i), one.name, std::string(name_of(one.task)), optional_cell(one.turn),
              optional_cell(one.grip_force), optional_cell(one.strength_share),
              optional_cell(one.strength),
              one.least_grip_force > 0.0 ? formats::shortest(one.least_grip_force) : "",
              one.limit_depths ? "1" : "0", formats::shortest(one.palm_limit_depth),
              formats::shortest(one.finger_limit_depth), formats::shortest(one.friction),
              one.is_balanced ? "1" : "0", name_of(one.model), one.indices ? "1" : "0",
              one.wrench_volume ? "1" : "0", one.torque ? "1" : "0", one.refine ? "1" : "0",
              one.is_place_per_hand ? "per_hand" : "shared"});
  }
  return file.finish();
}

std::vector<std::string> posture_header() {
  std::vector<std::string> header = {"number"};
  for (int d = 0; d < hand::kDofCount; ++d) {
    header.push_back(std::string(name_of(static_cast<hand::Dof>(d))) + "_deg");
  }
  for (const char* name :
       {"rotation_w", "rotation_x", "rotation_y", "rotation_z", "x_mm", "y_mm", "z_mm"}) {
    header.push_back(std::string("product_from_hand_") + name);
  }
  return header;
}

std::vector<std::string> posture_row(const study::StudyRecord& record) {
  std::vector<std::string> row = {std::to_string(record.number)};
  for (const double angle : record.posture.angle)
    row.push_back(formats::shortest(geometry::kDegreesPerRadian * angle));
  const Quat& q = record.product_from_hand.rotation;
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) row.push_back(formats::shortest(value));
  for (int c = 0; c < 3; ++c)
    row.push_back(formats::shortest(record.product_from_hand.translation[c]));
  return row;
}

std::vector<std::string> grasp_row(const study::StudyPlan& plan, const study::StudyRecord& record) {
  const study::StudyTask task = study::task_at(plan, record.number);
  const study::StudyHand& hand = plan.hands[task.hand];
  const auto& asked = plan.grips[task.grip];
  std::vector<std::string> row = {std::to_string(record.number),
                                  std::to_string(task.hand),
                                  plan.populations[hand.population].population.name,
                                  hand.sample.label,
                                  plan.profiles[task.profile].name,
                                  plan.settings[task.setting].name,
                                  plan.products[task.product].name,
                                  asked ? std::string(name_of(*asked)) : "auto",
                                  name_of(record.outcome),
                                  record.reason,
                                  std::string(name_of(record.grip)),
                                  record.is_balanced ? "1" : "0"};
  for (const double value :
       {record.grip_force, record.force, record.area, record.peak_pressure,
        record.peak_pressure_cells, record.mean_pressure, record.demand.range_share,
        record.demand.grip_strength, record.demand.nail_room}) {
    row.push_back(formats::shortest(value));
  }
  row.push_back(contact::fallbacks_in_words(record.fallbacks));
  if (!record.hold) {
    row.resize(row.size() + 7);
    return row;
  }
  const grasp::Hold& hold = record.hold->hold;
  row.insert(row.end(),
             {std::to_string(hold.part), hold.part_name,
              record.hold->kind ? name_of(*record.hold->kind) : "", formats::shortest(hold.along),
              std::to_string(hold.toward),
              formats::shortest(hold.turn * geometry::kDegreesPerRadian), record.hold->words});
  return row;
}

void add_field(CsvWriter& file, const std::string& number, const study::SparseField& field) {
  for (std::size_t i = 0; i < field.vertex.size(); ++i) {
    file.add({number, std::to_string(field.vertex[i]),
              formats::shortest(static_cast<double>(field.value[i]))});
  }
}

}  // namespace

std::vector<fs::path> export_study(const StudyStore& store, const fs::path& folder,
                                   bool with_fields, const Progress& progress) {
  formats::create_folder(folder);
  const study::StudyPlan& plan = store.plan();
  std::vector<fs::path> files = {write_hands(plan, folder), write_products(plan, folder),
                                 write_profiles(plan, folder), write_settings(plan, folder)};
  CsvWriter grasps(folder / "grasps.csv", {"number",
                                           "hand",
                                           "population",
                                           "label",
                                           "profile",
                                           "setting",
                                           "product",
                                           "asked_grip",
                                           "outcome",
                                           "reason",
                                           "grip",
                                           "is_balanced",
                                           "grip_force_n",
                                           "force_n",
                                           "contact_area_mm2",
                                           "peak_pressure_mpa",
                                           "peak_pressure_cells_mpa",
                                           "mean_pressure_mpa",
                                           "demand_range_share",
                                           "demand_grip_strength_n",
                                           "demand_nail_room_mm",
                                           "solver_fallbacks",
                                           "part",
                                           "part_name",
                                           "part_kind",
                                           "along",
                                           "toward",
                                           "turn_deg",
                                           "hold"});
  CsvWriter regions(folder / "regions.csv",
                    {"number", "region", "force_n", "contact_area_mm2", "peak_pressure_mpa",
                     "peak_pressure_cells_mpa", "mean_pressure_mpa"});
  std::vector<std::string> keys, index_header = {"number"};
  for (const grasp::GraspIndex& one : study::index_catalogue()) keys.push_back(one.key);
  index_header.insert(index_header.end(), keys.begin(), keys.end());
  CsvWriter indices(folder / "indices.csv", index_header);
  CsvWriter postures(folder / "postures.csv", posture_header());
  std::unique_ptr<CsvWriter> skin, product;
  if (with_fields) {
    const std::vector<std::string> header = {"number", "vertex", "pressure_mpa"};
    skin = std::make_unique<CsvWriter>(folder / "skin_pressure.csv", header);
    product = std::make_unique<CsvWriter>(folder / "product_pressure.csv", header);
  }
  const auto total = static_cast<double>(study::task_count(plan));
  store.for_each(with_fields, [&](const study::StudyRecord& record) {
    progress.update(static_cast<double>(record.number) / total, "writing tables");
    const std::string number = std::to_string(record.number);
    grasps.add(grasp_row(plan, record));
    for (const study::RegionRecord& one : record.regions) {
      regions.add({number, std::string(name_of(one.region)), formats::shortest(one.force),
                   formats::shortest(one.area), formats::shortest(one.peak_pressure),
                   formats::shortest(one.peak_pressure_cells),
                   formats::shortest(one.mean_pressure)});
    }
    std::map<std::string, double> values;
    for (const study::IndexRecord& one : record.indices) values[one.key] = one.value;
    std::vector<std::string> row = {number};
    for (const std::string& key : keys) {
      const auto found = values.find(key);
      row.push_back(found == values.end() ? "" : formats::shortest(found->second));
    }
    indices.add(std::move(row));
    postures.add(posture_row(record));
    if (with_fields) {
      add_field(*skin, number, record.skin_pressure);
      add_field(*product, number, record.product_pressure);
    }
  });
  for (CsvWriter* file : {&grasps, &regions, &indices, &postures}) files.push_back(file->finish());
  if (with_fields) {
    files.push_back(skin->finish());
    files.push_back(product->finish());
  }
  formats::write_file(folder / "plan.json", format_plan(plan) + "\n");
  files.push_back(folder / "plan.json");
  return files;
}

}  // namespace palmar::records
