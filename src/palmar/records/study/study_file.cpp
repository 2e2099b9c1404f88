// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <set>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/formats/toml_section.h"
#include "palmar/product/parametric_kinds.h"
#include "palmar/records/hold/hold_file.h"
#include "palmar/records/product/parameter_sweep.h"
#include "palmar/study/assessment/grasp_indices.h"
#include "palmar/study/statistics/study_results.h"

namespace palmar::records {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxStudyBytes = 1 << 20;
constexpr double kAny = 1e6;  // mm; bound of coordinates

/// Runs `body`; what a module below complains of gets the file's line.
template <typename Body>
auto at_key(const formats::TomlSection& section, const std::string& key, const Body& body) {
  try {
    return body();
  } catch (const UsageError& error) {
    section.fail(key, std::string("= ") + *section.text(key) + ": " + error.what());
  }
}

std::string place_of(const formats::TomlSection& section) {
  const auto line = std::max<std::uint32_t>(1, section.values().source().begin.line);
  return section.path() + ":" + std::to_string(line) + ": ";
}

/// A path in the file starts from the file's folder.
std::string from_folder(const formats::TomlSection& section, const std::string& path) {
  if (fs::path(path).is_absolute()) return path;
  return (fs::path(section.path()).parent_path() / path).string();
}

std::optional<Vec3> read_vector(const formats::TomlSection& section, const std::string& key,
                                const std::string& unit) {
  if (!section.has(key)) return std::nullopt;
  const std::vector<double> values = section.numbers(key, unit, -kAny, kAny);
  if (values.size() != 3) {
    section.fail(key, "has " + std::to_string(values.size()) +
                          " numbers; three, x, y and z, are "
                          "needed");
  }
  return Vec3(values[0], values[1], values[2]);
}

PopulationRequest read_population_request(const formats::TomlSection& section) {
  section.allow({"preset", "file", "table", "design", "hands", "residuals", "boundary",
                 "boundary_points", "percentiles", "seed"});
  PopulationRequest request;
  request.where = place_of(section);
  request.preset = section.text("preset").value_or("");
  request.file = section.text("file").value_or("");
  request.table = section.text("table").value_or("");
  const int given = static_cast<int>(section.has("preset")) +
                    static_cast<int>(section.has("file")) + static_cast<int>(section.has("table"));
  if (given != 1) {
    section.fail(given == 0 ? "says not whose hands: preset, file or table is required"
                            : "preset, file and table exclude each other; one is allowed");
  }
  if (!request.file.empty()) request.file = from_folder(section, request.file);
  if (!request.table.empty()) {
    request.table = from_folder(section, request.table);
    for (const char* key :
         {"design", "hands", "residuals", "boundary", "boundary_points", "percentiles", "seed"}) {
      if (section.has(key)) section.fail(key, "has no meaning with table: its hands are given");
    }
  }
  population::SamplingOptions& sampling = request.sampling;
  if (const auto design = section.text("design")) {
    const auto known = population::sampling_design_named(*design);
    if (!known) {
      section.fail("design", "is " + formats::in_quotes(*design) +
                                 "; latin_hypercube, random, boundary or percentiles is allowed");
    }
    sampling.design = *known;
  }
  if (const auto hands = section.integer("hands", 1, 1'000'000)) {
    sampling.hands = static_cast<int>(*hands);
  }
  sampling.residuals = section.boolean("residuals").value_or(sampling.residuals);
  sampling.boundary = section.number("boundary", "", 0.01, 0.9999).value_or(sampling.boundary);
  if (const auto points = section.integer("boundary_points", 1, 10'000)) {
    sampling.boundary_points = static_cast<int>(*points);
  }
  if (section.has("percentiles")) {
    sampling.percentiles = section.numbers("percentiles", "", 0.01, 99.99);
  }
  if (const auto seed = section.integer("seed", 0, INT64_MAX)) {
    sampling.seed = static_cast<std::uint64_t>(*seed);
    request.has_seed = true;
  }
  try {
    sampling.check();
  } catch (const UsageError& error) {
    section.fail(error.what());
  }
  return request;
}

population::HandProfile read_profile(const formats::TomlSection& section) {
  section.allow({"name", "range_share", "strength_share", "glove_thickness_mm",
                 "glove_shear_modulus_mpa", "nail_length_mm", "size_factor", "source"});
  const std::string name = section.need_text("name");
  population::HandProfile profile;
  profile.name = name;
  const bool is_own = section.values().size() > 1;  // only a name: one of ours
  for (const population::HandProfile& known : population::built_in_profiles()) {
    if (known.name == name) profile = known;
  }
  if (!is_own) profile = at_key(section, "name", [&] { return population::profile_named(name); });
  const auto set = [&](const char* key, const char* unit, double lowest, double highest,
                       double& value) {
    value = section.number(key, unit, lowest, highest).value_or(value);
  };
  set("range_share", "", 0.01, 1.0, profile.range_share);
  set("strength_share", "", 0.01, 10.0, profile.strength_share);
  set("glove_thickness_mm", "mm", 0.0, 10.0, profile.glove_thickness);
  set("glove_shear_modulus_mpa", "MPa", 1e-3, 100.0, profile.glove_shear_modulus);
  set("nail_length_mm", "mm", 0.0, 50.0, profile.nail_length);
  set("size_factor", "", 0.2, 2.0, profile.size_factor);
  if (const auto source = section.text("source")) {
    profile.source = *source;
  } else if (is_own) {
    profile.source = "given in " + fs::path(section.path()).filename().string();
  }
  try {
    profile.check();
  } catch (const UsageError& error) {
    section.fail(error.what());
  }
  return profile;
}

/// 35, [30, 35, 40], {from = 30, to = 50, step = 5} or "30:50:5".
std::vector<double> read_sweep(const formats::TomlSection& section,
                               const product::KindParameter& parameter) {
  const std::string& key = parameter.name;
  const std::string unit = product::unit_of_parameter(key);
  const double lowest = parameter.lowest, highest = parameter.highest;
  const toml::node* node = section.values().get(key);
  if (node->is_string()) {
    return at_key(section, key, [&] { return parse_sweep(key, *section.text(key)); });
  }
  if (node->is_array()) {
    const std::vector<double> values = section.numbers(key, unit, lowest, highest);
    if (values.empty()) section.fail(key, "is an empty list; at least one value is needed");
    return values;
  }
  if (!node->is_table()) return {section.need_number(key, unit, lowest, highest)};
  const formats::TomlSection sweep = *section.table(key);
  sweep.allow({"from", "to", "step"});
  const double from = sweep.need_number("from", unit, lowest, highest);
  const double to = sweep.need_number("to", unit, from, highest);
  const double step = sweep.need_number("step", unit, 1e-3, highest);
  try {
    return sweep_values(key, from, to, step);
  } catch (const UsageError& error) {
    section.fail(error.what());
  }
}

/// "+x", "-z", "up", "down" or a list of three numbers.
std::optional<Vec3> read_direction(const formats::TomlSection& section, const char* key,
                                   const Vec3& up) {
  const toml::node* node = section.values().get(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) {
    const auto direction = read_vector(section, key, "");
    if (direction && !(direction->norm() > 0.0)) {
      section.fail(key, "is 0, 0, 0; a direction is required");
    }
    return direction;
  }
  const std::string text = *section.text(key);
  if (text == "up") return up;
  if (text == "down") return Vec3(-up);
  const bool has_sign = !text.empty() && (text[0] == '+' || text[0] == '-');
  const std::string axis = has_sign ? text.substr(1) : text;
  if (axis != "x" && axis != "y" && axis != "z") {
    section.fail(key, "is " + formats::in_quotes(text) +
                          "; up, down, an axis as \"+x\" or [x, y, z] is allowed");
  }
  return Vec3((text[0] == '-' ? -1.0 : 1.0) * Vec3::Unit(axis[0] - 'x'));
}

/// By which part and how a product is held, without coordinates.
grasp::HoldRequest read_holding(const formats::TomlSection& section) {
  constexpr int kMostNumber = 10'000;
  grasp::HoldRequest holding;
  const auto is_text = [&](const char* key) {
    const toml::node* node = section.values().get(key);
    return node != nullptr && node->is_string();
  };
  if (is_text("hold")) {
    holding.hold = read_hold(from_folder(section, *section.text("hold"))).hold;
  } else if (const auto number = section.integer("hold", 1, kMostNumber)) {
    holding.number = static_cast<int>(*number);
  }
  if (is_text("part")) {
    holding.part_name = *section.text("part");
  } else if (const auto part = section.integer("part", 1, kMostNumber)) {
    holding.part = static_cast<int>(*part);
  }
  holding.along = section.number("along", "", 0.0, 1.0);
  holding.up = read_direction(section, "up", Vec3::UnitZ());
  holding.toward = read_direction(section, "toward", holding.up.value_or(Vec3::UnitZ()));
  if (const auto purpose = section.text("purpose")) {
    if (*purpose != "use" && *purpose != "hand_over") {
      section.fail("purpose",
                   "is " + formats::in_quotes(*purpose) + "; use or hand_over is allowed");
    }
    if (*purpose == "hand_over") holding.purpose = grasp::HoldPurpose::kHandOver;
  }
  return holding;
}

void check_holding(const formats::TomlSection& section, const study::StudyProduct& product) {
  grasp::GraspSettings settings;
  settings.placement.at = product.at;
  settings.placement.axis = product.axis;
  settings.holding = product.holding;
  try {
    settings.check();
  } catch (const UsageError& error) {
    section.fail(error.what());
  }
}

/// A product of the file; a sweep over a parameter makes several.
std::vector<ProductRequest> read_products(const formats::TomlSection& section) {
  std::vector<std::string> known = {"name",    "file",       "unit", "sizes",  "at_mm", "axis",
                                    "mass_kg", "posture_of", "kind", "family", "hold",  "part",
                                    "along",   "toward",     "up",   "purpose"};
  const std::string kind = section.text("kind").value_or("");
  const product::ParametricKind* made = nullptr;
  if (section.has("kind")) {
    made = at_key(section, "kind", [&] { return &product::parametric_kind(kind); });
    for (const product::KindParameter& one : made->parameters) known.push_back(one.name);
  }
  section.allow(known);
  if (section.has("file") == section.has("kind")) {
    section.fail(section.has("file") ? "file and kind exclude each other; one is allowed"
                                     : "has neither file nor kind; one of them is required");
  }
  ProductRequest request;
  request.where = place_of(section);
  request.name = section.text("name").value_or("");
  if (const auto file = section.text("file")) {
    request.file = from_folder(section, *file);
    request.written = *file;
  }
  if (const auto unit = section.text("unit")) {
    if (request.file.empty()) section.fail("unit", "has no meaning for a solid: it is in mm");
    request.unit = at_key(section, "unit", [&] { return geometry::length_unit(*unit); });
  }
  if (section.has("sizes")) {
    request.sizes = section.numbers("sizes", "", 0.05, 20.0);
    if (request.sizes.empty()) section.fail("sizes", "is an empty list; [1.0] is usual");
    const std::set<double> different(request.sizes.begin(), request.sizes.end());
    if (different.size() < request.sizes.size()) section.fail("sizes", "has a size twice");
  }
  request.held.at = read_vector(section, "at_mm", "mm");
  request.held.axis = read_vector(section, "axis", "");
  if (request.held.axis && !(request.held.axis->norm() > 0.0)) {
    section.fail("axis", "is 0, 0, 0; a direction is required");
  }
  request.held.holding = read_holding(section);
  check_holding(section, request.held);
  request.held.mass = section.number("mass_kg", "kg", 0.0, 100.0).value_or(0.0);
  request.held.posture_of = section.text("posture_of").value_or("");
  request.held.family = section.text("family").value_or("");
  if (made == nullptr) return {request};

  MadeSweep sweep{kind, {}};
  for (const product::KindParameter& one : made->parameters) {
    if (section.has(one.name)) sweep.given.emplace_back(one.name, read_sweep(section, one));
  }
  std::vector<MadeVariant> variants;
  try {
    variants = variants_of(sweep);
  } catch (const UsageError& error) {
    section.fail(error.what());
  }
  std::vector<ProductRequest> requests;
  for (MadeVariant& one : variants) {
    requests.push_back(request);
    requests.back().made = std::move(one.product);
    if (one.suffix.empty()) continue;
    const std::string name = request.name.empty() ? kind : request.name;
    if (request.held.family.empty()) requests.back().held.family = name;
    requests.back().name = name + " " + one.suffix;
  }
  return requests;
}

/// The word under `key`, if there is one: the name of one of `allowed`.
template <typename Enum, std::size_t kCount>
void read_word(const formats::TomlSection& section, const char* key,
               const std::array<Enum, kCount>& allowed, Enum& value) {
  const auto word = section.text(key);
  if (!word) return;
  std::string list;
  for (const Enum one : allowed) {
    if (*word == name_of(one)) {
      value = one;
      return;
    }
    list += (list.empty() ? "" : " or ") + std::string(name_of(one));
  }
  section.fail(key, "is " + formats::in_quotes(*word) + "; " + list + " is allowed");
}

study::StudySetting read_setting(const formats::TomlSection& section,
                                 const std::string& default_name) {
  section.allow({"name",
                 "palm_limit_depth_mm",
                 "finger_limit_depth_mm",
                 "grip_force_n",
                 "strength_share",
                 "strength_n",
                 "limit_depths",
                 "task",
                 "turn_n_m",
                 "friction",
                 "balance",
                 "preset",
                 "kernel",
                 "tissue_model",
                 "regions",
                 "indices",
                 "wrench_volume",
                 "torque",
                 "refine",
                 "place"});
  study::StudySetting setting;
  setting.name = section.text("name").value_or(default_name);
  const auto set = [&](const char* key, const char* unit, double lowest, double highest,
                       double& value) {
    value = section.number(key, unit, lowest, highest).value_or(value);
  };
  set("palm_limit_depth_mm", "mm", 0.1, 15.0, setting.palm_limit_depth);
  set("finger_limit_depth_mm", "mm", 0.1, 15.0, setting.finger_limit_depth);
  set("friction", "", 0.0, 3.0, setting.friction);
  setting.grip_force = section.number("grip_force_n", "N", 0.1, 5000.0);
  setting.strength_share = section.number("strength_share", "", 0.001, 1.0);
  if (setting.grip_force && setting.strength_share) {
    section.fail("strength_share", "and grip_force_n exclude each other; one is allowed");
  }
  setting.strength = section.number("strength_n", "N", 1.0, 5000.0);
  if (setting.strength && !setting.strength_share) {
    section.fail("strength_n", "needs strength_share, the share of it to grip with");
  }
  setting.limit_depths = section.boolean("limit_depths").value_or(false);
  if (setting.limit_depths && (setting.grip_force || setting.strength_share)) {
    section.fail("limit_depths", std::string("and ") +
                                     (setting.grip_force ? "grip_force_n" : "strength_share") +
                                     " exclude each other; one is allowed");
  }
  read_word(section, "task", grasp::kHandTasks, setting.task);
  setting.turn =
      section.number("turn_n_m", "N m", -1e-3 * grasp::kMostTurn, 1e-3 * grasp::kMostTurn);
  if ((setting.task == grasp::HandTask::kTurn) != setting.turn.has_value()) {
    setting.turn ? section.fail("turn_n_m", "needs task = \"turn\"")
                 : section.fail("task", "is \"turn\"; turn_n_m, a torque, is required with it");
  }
  if (grasp::says_how_firmly(setting.task)) {
    for (const char* key : {"grip_force_n", "strength_share", "limit_depths"}) {
      if (!section.has(key)) continue;
      section.fail(key, "doesn't go with task = \"" + std::string(name_of(setting.task)) +
                            "\", which says how firmly to grip");
    }
  }
  if (const auto preset = section.text("preset")) {
    const auto model = contact::contact_model_named(*preset);
    if (!model) {
      section.fail("preset",
                   "is " + formats::in_quotes(*preset) + "; palmar or xie2014 is allowed");
    }
    setting.model = *model;
    // The thesis leaves the hand as it was closed.
    if (*preset == "xie2014") setting.is_balanced = false;
  }
  read_word(section, "kernel", contact::kKernels, setting.model.kernel);
  read_word(section, "tissue_model", contact::kTissueModels, setting.model.tissue);
  read_word(section, "regions", contact::kRegionCouplings, setting.model.coupling);
  if (!section.has("tissue_model")) setting.model = contact::with_permitted_tissue(setting.model);
  setting.is_balanced = section.boolean("balance").value_or(setting.is_balanced);
  setting.indices = section.boolean("indices").value_or(setting.indices);
  setting.wrench_volume = section.boolean("wrench_volume").value_or(setting.wrench_volume);
  setting.torque = section.boolean("torque").value_or(setting.torque);
  setting.refine = section.boolean("refine").value_or(setting.refine);
  if (const auto place = section.text("place")) {
    setting.is_place_per_hand = *place == "per_hand";
    if (!setting.is_place_per_hand && *place != "shared") {
      section.fail("place", "is " + formats::in_quotes(*place) + "; shared or per_hand is allowed");
    }
  }
  return setting;
}

/// Keys of every number that a grasp can have.
std::vector<std::string> quantity_keys() {
  std::vector<std::string> keys;
  for (const study::StudyQuantity& one : study::hand_quantities()) keys.push_back(one.key);
  for (const grasp::GraspIndex& one : study::index_catalogue()) keys.push_back(one.key);
  return keys;
}

study::StudyLimit read_limit(const formats::TomlSection& section) {
  section.allow({"quantity", "lowest", "highest"});
  study::StudyLimit limit;
  limit.quantity = section.need_text("quantity");
  const std::vector<std::string> keys = quantity_keys();
  if (std::find(keys.begin(), keys.end(), limit.quantity) == keys.end()) {
    const std::string nearest = nearest_name(limit.quantity, keys);
    section.fail("quantity", "is " + formats::in_quotes(limit.quantity) + ", which no grasp has" +
                                 (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
  }
  constexpr double kMost = 1e12;
  limit.lowest = section.number("lowest", "", -kMost, kMost);
  limit.highest = section.number("highest", "", -kMost, kMost);
  if (!limit.lowest && !limit.highest) {
    section.fail("has neither lowest nor highest; at least one is required");
  }
  if (limit.lowest && limit.highest && *limit.lowest > *limit.highest) {
    section.fail("lowest", "is " + formats::shortest(*limit.lowest) + ", above highest, " +
                               formats::shortest(*limit.highest));
  }
  return limit;
}

}  // namespace

PopulationRequest population_request(const std::string& words) {
  PopulationRequest request;
  const std::filesystem::path path = words;
  const bool is_file = words.find('/') != words.npos || path.has_extension();
  if (!is_file) {
    request.preset = words;
  } else if (path.extension() == ".toml") {
    request.file = words;
  } else {
    request.table = words;
  }
  return request;
}

std::optional<grasp::Grip> asked_grip_named(const std::string& name) {
  if (name == "any" || name == "auto") return std::nullopt;  // "auto": its name until 0.1.0
  if (const auto grip = grasp::grip_named(name)) return grip;
  std::vector<std::string> known = {"any"};
  for (int g = 0; g < grasp::kGripCount; ++g)
    known.emplace_back(name_of(static_cast<grasp::Grip>(g)));
  throw UsageError("grip " + formats::in_quotes(name) + " is not known; " +
                   did_you_mean(name, known, "allowed are " + joined(known, ", ")));
}

StudyRequest read_study_file(const std::string& path) {
  const std::string text = formats::read_file(path, kMaxStudyBytes);
  const toml::table values = formats::parse_toml(text, path);
  const formats::TomlSection file(path, "", values);
  file.allow({"study", "population", "profile", "product", "settings", "setting", "limit"});
  StudyRequest request;
  request.where = path;
  request.name = fs::path(path).stem().string();
  if (const auto study = file.table("study")) {
    study->allow({"name", "title", "seed", "hand", "grips"});
    request.name = study->text("name").value_or(request.name);
    request.title = study->text("title").value_or("");
    request.seed = static_cast<std::uint64_t>(study->integer("seed", 0, INT64_MAX).value_or(1));
    request.hand = study->text("hand").value_or("template");
    if (request.hand != "template") request.hand = from_folder(*study, request.hand);
    for (const std::string& name : study->texts("grips")) {
      try {
        request.grips.push_back(asked_grip_named(name));
      } catch (const UsageError& error) {
        study->fail("grips", std::string("has ") + error.what());
      }
    }
  }
  for (const formats::TomlSection& one : file.tables("population")) {
    request.populations.push_back(read_population_request(one));
  }
  if (request.populations.empty()) {
    file.fail("no [[population]]: whose hands is not said; preset = \"xie2014\" is one");
  }
  for (const formats::TomlSection& one : file.tables("profile")) {
    request.profiles.push_back(read_profile(one));
  }
  for (const formats::TomlSection& one : file.tables("product")) {
    for (ProductRequest& product : read_products(one)) {
      request.products.push_back(std::move(product));
    }
  }
  if (request.products.empty()) {
    file.fail("no [[product]]: what is held is not said; file = \"handle.stl\" is one");
  }
  if (file.has("settings") && file.has("setting")) {
    file.fail("setting", "and [settings] exclude each other; one of them is allowed");
  }
  if (const auto settings = file.table("settings")) {
    request.settings.push_back(read_setting(*settings, "default"));
  }
  for (const formats::TomlSection& one : file.tables("setting")) {
    request.settings.push_back(
        read_setting(one, "setting " + std::to_string(request.settings.size() + 1)));
  }
  for (const formats::TomlSection& one : file.tables("limit"))
    request.limits.push_back(read_limit(one));
  return request;
}

}  // namespace palmar::records
