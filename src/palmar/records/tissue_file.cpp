// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/tissue_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/formats/toml_section.h"
#include "palmar/hand/tissue.h"

namespace palmar::records {
namespace {

constexpr std::uint64_t kMostTissueBytes = 1 << 20;  // a set of all regions has 20 kB
constexpr double kKpaPerMpa = 1000.0;

/// One number of a law: its key is name + level + unit, as in g0_low_kpa.
struct LawKey {
  const char* name;
  const char* ending;
  const char* unit;
  double hand::StiffeningLaw::*value;
  double factor;  ///< file's unit / ours
  double lowest, highest;
};
constexpr double kSmallestLength = 1e-3;  // mm; stands for "more than 0"
constexpr std::array<LawKey, 3> kLawKeys = {
    {{"g0", "_kpa", "kPa", &hand::StiffeningLaw::g0, kKpaPerMpa, kKpaPerMpa* hand::kMinShearModulus,
      kKpaPerMpa* hand::kMaxShearModulus},
     {"g_limit", "_kpa", "kPa", &hand::StiffeningLaw::g_limit, kKpaPerMpa,
      kKpaPerMpa* hand::kMinShearModulus, kKpaPerMpa* hand::kMaxShearModulus},
     {"limit_depth", "_mm", "mm", &hand::StiffeningLaw::limit_depth, 1.0, kSmallestLength,
      hand::kMaxTissueLength}}};

struct Level {
  const char* suffix;
  hand::StiffeningLaw hand::TissueStiffness::*law;
};
constexpr std::array<Level, 3> kLevels = {{{"", &hand::TissueStiffness::nominal},
                                           {"_low", &hand::TissueStiffness::low},
                                           {"_high", &hand::TissueStiffness::high}}};

std::string key_of(const LawKey& key, const Level& level) {
  return std::string(key.name) + level.suffix + key.ending;
}

struct RegionKey {
  const char* name;
  const char* unit;
  double hand::RegionTissue::*value;
  double lowest, highest;
};
constexpr std::array<RegionKey, 5> kRegionKeys = {
    {{"poisson_layered", "", &hand::RegionTissue::poisson_layered, 0.0, 0.5},
     {"swelling_height_mm", "mm", &hand::RegionTissue::swelling_height, 0.0,
      hand::kMaxTissueLength},
     {"swelling_radius_mm", "mm", &hand::RegionTissue::swelling_radius, kSmallestLength,
      hand::kMaxTissueLength},
     {"swelling_width_mm", "mm", &hand::RegionTissue::swelling_width, kSmallestLength,
      hand::kMaxTissueLength},
     {"neighbourhood_mm", "mm", &hand::RegionTissue::neighbourhood, kSmallestLength,
      hand::kMaxTissueLength}}};

struct BoneKey {
  const char* name;
  const char* ending;
  const char* unit;
  double hand::BoneTissueLaw::*value;
  double factor;  ///< file / MPa
  double lowest, highest;
};
constexpr std::array<BoneKey, 2> kBoneKeys = {
    {{"g0", "_kpa", "kPa", &hand::BoneTissueLaw::g0, kKpaPerMpa, kKpaPerMpa* hand::kMinShearModulus,
      kKpaPerMpa* hand::kMaxShearModulus},
     {"stiffening", "", "", &hand::BoneTissueLaw::stiffening, 1.0, 0.0,
      hand::kMostBoneStiffening}}};

struct BoneLevel {
  const char* suffix;
  hand::BoneTissueLaw hand::BoneTissue::*law;
};
constexpr std::array<BoneLevel, 3> kBoneLevels = {{{"", &hand::BoneTissue::nominal},
                                                   {"_low", &hand::BoneTissue::low},
                                                   {"_high", &hand::BoneTissue::high}}};

std::string key_of(const BoneKey& key, const BoneLevel& level) {
  return std::string(key.name) + level.suffix + key.ending;
}

struct ModelKey {
  const char* name;
  hand::TissueStiffness hand::RegionTissue::*stiffness;
};
constexpr std::array<ModelKey, 2> kModelKeys = {
    {{"half_space", &hand::RegionTissue::half_space}, {"layered", &hand::RegionTissue::layered}}};

/// Reads one file over a base set.
class TissueReader {
 public:
  TissueReader(std::string path, hand::Tissue base)
      : path_(std::move(path)), tissue_(std::move(base)) {}

  hand::Tissue read(const toml::table& file) {
    std::vector<std::string> known = {"version", "source", "region"};
    for (int c = 0; c < hand::kTissueClassCount; ++c) {
      known.emplace_back(name_of(static_cast<hand::TissueClass>(c)));
    }
    for (const auto& [key, node] : file) {
      const std::string name(key.str());
      if (name == "version") {
        check_version(key, node);
      } else if (name == "source") {
        tissue_.source = text(key, node, "");
      } else if (hand::tissue_class_named(name)) {
        table(key, node, name);
      } else if (name == "region") {
        for (const auto& [region, ignored] : table(key, node, name)) check_region(region);
      } else {
        unknown(key, "the file", known);
      }
    }
    for (int r = 0; r < hand::kRegionCount; ++r) {
      const auto region = static_cast<hand::Region>(r);
      hand::RegionTissue& one = tissue_.region[r];
      const std::string group(name_of(hand::tissue_class_of(region)));
      if (const toml::table* values = file[group].as_table()) apply(*values, group, one);
      const std::string name(name_of(region));
      if (const toml::node* values = file["region"][name].node()) {
        if (!values->is_table()) fail(*values, "[region." + name + "] must be a table");
        apply(*values->as_table(), "region." + name, one);
      }
      const std::string fault = hand::fault_of(one);
      if (!fault.empty()) throw InputError(path_ + ": tissue of " + name + ": " + fault);
    }
    return std::move(tissue_);
  }

 private:
  [[noreturn]] void fail(const toml::source_region& where, const std::string& why) const {
    throw InputError(path_ + ":" + std::to_string(where.begin.line) + ": " + why);
  }
  [[noreturn]] void fail(const toml::node& node, const std::string& why) const {
    fail(node.source(), why);
  }
  [[noreturn]] void unknown(const toml::key& key, const std::string& section,
                            const std::vector<std::string>& known) const {
    const std::string name(key.str());
    fail(key.source(), section + ": key " + formats::in_quotes(name) + " is not known; " +
                           did_you_mean(name, known, "allowed are " + joined(known, ", ")));
  }

  void check_version(const toml::key& key, const toml::node& node) const {
    const auto version = node.value_exact<std::int64_t>();
    if (!version || *version < 1) fail(key.source(), "version must be a whole number from 1");
    if (*version > kTissueFileVersion) {
      fail(key.source(), "tissue file of version " + std::to_string(*version) +
                             "; this program reads up to version " +
                             std::to_string(kTissueFileVersion) + " (a newer Palmar wrote it)");
    }
  }

  void check_region(const toml::key& key) const {
    if (hand::region_named(key.str())) return;
    std::vector<std::string> known;
    for (int r = 0; r < hand::kRegionCount; ++r)
      known.emplace_back(name_of(static_cast<hand::Region>(r)));
    unknown(key, "[region]", known);
  }

  const toml::table& table(const toml::key& key, const toml::node& node,
                           const std::string& section) const {
    if (const toml::table* values = node.as_table()) return *values;
    fail(key.source(), "\"" + section + "\" must be a table, as in [" + section + "]");
  }

  std::string text(const toml::key& key, const toml::node& node, const std::string& section) const {
    if (const auto value = node.value_exact<std::string>()) return *value;
    fail(key.source(), section + std::string(key.str()) + " must be text in quotes");
  }

  double number(const toml::key& key, const toml::node& node, const std::string& section,
                const std::string& unit, double lowest, double highest) const {
    const std::string what = "[" + section + "] " + std::string(key.str());
    std::ostringstream allowed;
    allowed << lowest << " to " << highest << (unit.empty() ? "" : " ") << unit << " is allowed";
    const auto value = node.value<double>();
    if (!value || node.is_boolean()) fail(key.source(), what + " is no number; " + allowed.str());
    if (!(*value >= lowest && *value <= highest)) {
      std::ostringstream message;
      message << what << " is " << *value << (unit.empty() ? "" : " ") << unit << "; "
              << allowed.str();
      fail(key.source(), message.str());
    }
    return *value;
  }

  void apply(const toml::table& values, const std::string& section,
             hand::RegionTissue& region) const {
    std::vector<std::string> known = {"source"};
    for (const ModelKey& model : kModelKeys) known.emplace_back(model.name);
    known.emplace_back("on_bone");
    for (const RegionKey& item : kRegionKeys) known.emplace_back(item.name);
    for (const auto& [key, node] : values) {
      const std::string name(key.str());
      const auto is_named = [&name](const auto& item) { return name == item.name; };
      const auto* number_key = std::find_if(kRegionKeys.begin(), kRegionKeys.end(), is_named);
      const auto* model_key = std::find_if(kModelKeys.begin(), kModelKeys.end(), is_named);
      if (name == "source") {
        region.source = text(key, node, "[" + section + "] ");
      } else if (number_key != kRegionKeys.end()) {
        region.*number_key->value =
            number(key, node, section, number_key->unit, number_key->lowest, number_key->highest);
      } else if (model_key != kModelKeys.end()) {
        const std::string below = section + "." + name;
        apply_law(table(key, node, below), below, region.*model_key->stiffness, kLawKeys, kLevels);
      } else if (name == "on_bone") {
        const std::string below = section + ".on_bone";
        apply_law(table(key, node, below), below, region.on_bone, kBoneKeys, kBoneLevels);
      } else {
        unknown(key, "[" + section + "]", known);
      }
    }
  }

  /// `keys` of a law and its `levels`, the first of which is the nominal one.
  template <typename Laws, typename Keys, typename Levels>
  void apply_law(const toml::table& values, const std::string& section, Laws& laws,
                 const Keys& keys, const Levels& levels) const {
    std::vector<std::string> known;
    for (const auto& item : keys) {
      for (const auto& level : levels) known.push_back(key_of(item, level));
    }
    for (const auto& [key, ignored] : values) {
      if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
        unknown(key, "[" + section + "]", known);
      }
    }
    for (const auto& item : keys) {
      for (const auto& level : levels) {
        const auto found = values.find(key_of(item, level));
        if (found == values.end()) continue;
        const double value =
            number(found->first, found->second, section, item.unit, item.lowest, item.highest) /
            item.factor;
        (laws.*level.law).*item.value = value;
        // A value without a range has none; keys of the range come after it and put it back.
        if (level.law == levels[0].law) {
          laws.low.*item.value = value;
          laws.high.*item.value = value;
        }
      }
    }
  }

  std::string path_;
  hand::Tissue tissue_;
};

/// 15 digits where they say it to the last bit but one, so that 0.07 MPa is written as 70 kPa.
std::string decimal(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(15);
  text << value;
  std::string digits = text.str();
  const double back = formats::parse_double(digits).value_or(0.0);
  constexpr double kOneBit = 2.3e-16;  // relative
  if (std::abs(back - value) > kOneBit * std::abs(value)) digits = formats::shortest(value);
  const bool is_float = digits.find_first_of(".en") != std::string::npos;
  return is_float ? digits : digits + ".0";
}

/// TOML's basic strings have JSON's escapes.
std::string region_toml(const std::string& section, const hand::RegionTissue& region) {
  std::string text = "\n[" + section + "]\n";
  if (!region.source.empty()) text += "source = " + formats::toml_string(region.source) + "\n";
  for (const RegionKey& item : kRegionKeys) {
    text += std::string(item.name) + " = " + decimal(region.*item.value) + "\n";
  }
  const auto add_law = [&text](const auto& laws, const auto& keys, const auto& levels) {
    for (const auto& item : keys) {
      for (const auto& level : levels) {
        const double value = (laws.*level.law).*item.value;
        const bool is_nominal = level.law == levels[0].law;
        if (!is_nominal && value == laws.nominal.*item.value) continue;
        text += key_of(item, level) + " = " + decimal(value * item.factor) + "\n";
      }
    }
  };
  for (const ModelKey& model : kModelKeys) {
    text += "\n[" + section + "." + model.name + "]\n";
    add_law(region.*model.stiffness, kLawKeys, kLevels);
  }
  text += "\n[" + section + ".on_bone]\n";
  add_law(region.on_bone, kBoneKeys, kBoneLevels);
  return text;
}

}  // namespace

hand::Tissue read_tissue(const std::string& path, const hand::Tissue& base) {
  return TissueReader(path, base)
      .read(formats::parse_toml(formats::read_file(path, kMostTissueBytes), path));
}

std::string tissue_toml(const hand::Tissue& tissue) {
  std::string text =
      "# Tissue of a hand; see docs/using/tissue.md. Moduli in kPa, lengths in mm.\n";
  text += "version = " + std::to_string(kTissueFileVersion) + "\n";
  text += "source = " + formats::toml_string(tissue.source) + "\n";
  std::array<const hand::RegionTissue*, hand::kTissueClassCount> group{};
  for (int r = 0; r < hand::kRegionCount; ++r) {
    const hand::RegionTissue*& first =
        group[index_of(hand::tissue_class_of(static_cast<hand::Region>(r)))];
    if (first == nullptr) first = &tissue.region[r];
  }
  for (int c = 0; c < hand::kTissueClassCount; ++c) {
    text += region_toml(std::string(name_of(static_cast<hand::TissueClass>(c))), *group[c]);
  }
  for (int r = 0; r < hand::kRegionCount; ++r) {
    const auto region = static_cast<hand::Region>(r);
    const hand::RegionTissue& one = tissue.region[r];
    if (one == *group[index_of(hand::tissue_class_of(region))]) continue;
    text += region_toml("region." + std::string(name_of(region)), one);
  }
  return text;
}

void write_tissue(const std::string& path, const hand::Tissue& tissue) {
  formats::write_file(path, tissue_toml(tissue));
}

}  // namespace palmar::records
