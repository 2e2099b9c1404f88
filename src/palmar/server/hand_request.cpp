// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/hand_request.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/text_scan.h"
#include "palmar/server/access.h"

namespace palmar::server {
namespace {

using HandJson = nlohmann::ordered_json;

constexpr std::array kMethods = {HandMethod::kFile, HandMethod::kQuick, HandMethod::kScan,
                                 HandMethod::kPhotos, HandMethod::kMri};
constexpr std::size_t kMostCorrections = 2000;  // our choice: a scan has some hundred marks
constexpr double kFarthestMark = 1e5;           // mm; as person files have it
constexpr double kLongestSize = 500.0;          // mm; likewise

[[noreturn]] void refuse_hand(const std::string& member, const HandJson& value,
                              const std::string& allowed) {
  throw UsageError(
      "hand: \"" + member + "\" is " +
      formats::in_quotes(value.dump(-1, ' ', false, HandJson::error_handler_t::replace)) + "; " +
      allowed + " is required");
}

/// A word that is neither a path nor an option; "" if it isn't there.
std::string word_in(const HandJson& json, const char* name) {
  if (!json.contains(name) || json[name].is_null()) return {};
  const HandJson& value = json[name];
  if (!value.is_string()) refuse_hand(name, value, "a word");
  const auto text = value.get<std::string>();
  if (text.empty()) return text;
  if (!is_plain_name(text) || text.front() == '-') {
    refuse_hand(name, value, "a word of letters, digits, - and _");
  }
  return text;
}

std::string one_of(const HandJson& json, const char* name,
                   const std::vector<std::string>& allowed) {
  std::string word = word_in(json, name);
  if (!word.empty() && std::find(allowed.begin(), allowed.end(), word) == allowed.end()) {
    std::string words;
    for (const std::string& one : allowed) words += (words.empty() ? "" : ", ") + one;
    refuse_hand(name, json[name], "one of " + words);
  }
  return word;
}

/// The name of an ink, or #rrggbb.
std::string colour_in(const HandJson& json, const char* name) {
  const bool is_hex = json.contains(name) && json[name].is_string() &&
                      json[name].get<std::string>().starts_with('#');
  if (!is_hex) return word_in(json, name);
  const auto text = json[name].get<std::string>();
  const bool is_right = text.size() == 7 && std::all_of(text.begin() + 1, text.end(), [](char c) {
                          return std::isxdigit(static_cast<unsigned char>(c)) != 0;
                        });
  if (!is_right) refuse_hand(name, json[name], "a colour as #20a040");
  return text;
}

double size_of(const std::string& name, const HandJson& value, double low, double high) {
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!(number >= low && number <= high)) {
    refuse_hand(name, value,
                "a number from " + formats::shortest(low) + " to " + formats::shortest(high));
  }
  return number;
}

Vec3 place_in(const HandJson& json, const char* name) {
  if (!json.is_array() || json.size() != 3) refuse_hand(name, json, "three numbers");
  Vec3 place;
  for (std::size_t k = 0; k < 3; ++k) {
    place[static_cast<Eigen::Index>(k)] = size_of(name, json[k], -kFarthestMark, kFarthestMark);
  }
  return place;
}

std::optional<Vec3> point_in(const HandJson& json, const char* name) {
  if (!json.contains(name) || json[name].is_null()) return {};
  return place_in(json[name], name);
}

/// Adds what a correction says, the one of that number.
void add_correction(const HandJson& json, std::size_t number, records::PersonFile& known) {
  if (!json.is_object()) refuse_hand("corrections", json, "a list of objects");
  const std::string mark = one_of(json, "mark", {"crease", "dot", "added_crease", "added_dot"});
  const std::string name = word_in(json, "name"), posture = word_in(json, "posture");
  if (name.empty()) refuse_hand("name", json, "the name of a correction");
  const Vec3 place =
      place_in(json.contains("place_mm") ? json["place_mm"] : HandJson(), "place_mm");
  const std::string said_in = "correction " + std::to_string(number);
  if (mark.empty()) {
    known.bones.push_back({name, place, said_in});
    return;
  }
  if (mark.starts_with("added_") && name == "none") return;
  const auto label = records::mark_label_of(
      {posture.empty() ? "reference" : posture, mark, name, place, said_in},
      [&](const std::string& why) { throw UsageError("hand: " + said_in + ": " + why); });
  if (label) known.marks.push_back(*label);
}

HandJson row_of(const records::MarkText& mark) {
  return {{"posture", mark.posture},
          {"mark", mark.mark},
          {"name", mark.name},
          {"place_mm", {mark.point.x(), mark.point.y(), mark.point.z()}}};
}

HandJson point_or_null(const std::optional<Vec3>& point) {
  return point ? HandJson::array({point->x(), point->y(), point->z()}) : HandJson(nullptr);
}

std::string lower_ending(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

}  // namespace

std::string name_of(HandMethod method) {
  switch (method) {
    case HandMethod::kFile:
      return "file";
    case HandMethod::kQuick:
      return "quick";
    case HandMethod::kScan:
      return "scan";
    case HandMethod::kPhotos:
      return "photos";
    case HandMethod::kMri:
      return "mri";
  }
  return {};
}

HandRequest parse_hand_request(const HandJson& json) {
  HandRequest request;
  std::vector<std::string> names;
  for (const HandMethod one : kMethods) names.push_back(name_of(one));
  const std::string method = one_of(json, "method", names);
  if (method.empty()) refuse_hand("method", HandJson(), "file, quick, scan, photos or mri");
  request.method = kMethods[static_cast<std::size_t>(std::find(names.begin(), names.end(), method) -
                                                     names.begin())];
  request.uploads = word_in(json, "uploads");
  request.name = word_in(json, "name");
  records::PersonFile& known = request.known;
  const std::string side = one_of(json, "side", {"right", "left"});
  if (!side.empty()) known.side = side == "left" ? hand::Side::kLeft : hand::Side::kRight;
  known.pick_crease = point_in(json, "pick_crease");
  known.pick_dot = point_in(json, "pick_dot");
  request.crease_colour = colour_in(json, "crease_colour");
  request.dot_colour = colour_in(json, "dot_colour");
  request.population = word_in(json, "population");
  request.sheet = one_of(json, "sheet", {"a4", "letter", "card"});
  const std::string unit = one_of(json, "unit", {"mm", "cm", "m", "inch"});
  if (!unit.empty()) request.unit = geometry::length_unit(unit);
  if (json.contains("wrist_inside_mm") && !json["wrist_inside_mm"].is_null()) {
    request.wrist_inside = size_of("wrist_inside_mm", json["wrist_inside_mm"], -200.0, 200.0);
  }
  request.is_palm_up = json.contains("palm_up") && json["palm_up"] == true;
  const HandJson sizes = json.contains("sizes_mm") ? json["sizes_mm"] : HandJson();
  if (!sizes.is_null() && !sizes.is_object()) refuse_hand("sizes_mm", sizes, "an object");
  for (const auto& [name, value] : sizes.items()) {
    const auto dimension = hand::hand_dimension_named(name);
    if (!dimension) refuse_hand("sizes_mm", sizes, "names of dimensions (palmar hand measure)");
    known.sizes.push_back({*dimension, size_of(name, value, 1.0, kLongestSize)});
  }
  const HandJson rows = json.contains("corrections") ? json["corrections"] : HandJson();
  if (!rows.is_null() && (!rows.is_array() || rows.size() > kMostCorrections)) {
    refuse_hand("corrections", "...", "a list of at most 2000");
  }
  for (std::size_t k = 0; k < rows.size(); ++k) add_correction(rows[k], k + 1, known);
  if (request.uploads.empty() && (request.method != HandMethod::kQuick || known.sizes.empty())) {
    refuse_hand("uploads", HandJson(), "the key of the files that were sent");
  }
  return request;
}

void write_hand_request(const HandRequest& request, HandJson& json) {
  const auto or_null = [](const std::string& word) {
    return word.empty() ? HandJson(nullptr) : HandJson(word);
  };
  json["method"] = name_of(request.method);
  json["uploads"] = request.uploads;
  json["name"] = request.name;
  const records::PersonFile& known = request.known;
  json["side"] = known.side ? HandJson(std::string(name_of(*known.side))) : HandJson(nullptr);
  json["unit"] = request.unit ? HandJson(name_of(*request.unit)) : HandJson(nullptr);
  json["crease_colour"] = or_null(request.crease_colour);
  json["dot_colour"] = or_null(request.dot_colour);
  json["population"] = or_null(request.population);
  json["sheet"] = or_null(request.sheet);
  json["wrist_inside_mm"] = request.wrist_inside;
  json["palm_up"] = request.is_palm_up;
  json["pick_crease"] = point_or_null(known.pick_crease);
  json["pick_dot"] = point_or_null(known.pick_dot);
  json["sizes_mm"] = HandJson::object();
  for (const hand::SizedDimension& one : known.sizes) {
    json["sizes_mm"][name_of(one.dimension)] = one.value;
  }
  HandJson rows = HandJson::array();
  for (const hand::MarkLabel& one : known.marks) rows.push_back(row_of(records::mark_text_of(one)));
  for (const hand::BoneLabel& one : known.bones) {
    rows.push_back(
        row_of({.posture = {}, .mark = {}, .name = one.name, .point = one.point, .place = {}}));
  }
  json["corrections"] = std::move(rows);
}

std::filesystem::path hand_result(const HandRequest& request,
                                  const std::vector<std::string>& sources) {
  if (request.method == HandMethod::kFile) return sources.empty() ? "" : sources.front();
  return std::filesystem::path(kHandFound) /
         ((request.name.empty() ? "hand" : request.name) + ".hand.glb");
}

std::vector<std::string> hand_words(const HandRequest& request,
                                    const std::vector<std::string>& sources,
                                    const std::string& folder, const std::string& language) {
  std::vector<std::string> words = {"hand"};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  if (request.method == HandMethod::kFile) {
    words.emplace_back("info");
    words.insert(words.end(), sources.begin(), sources.end());
    return words;
  }
  const bool is_quick = request.method == HandMethod::kQuick;
  words.push_back(is_quick ? "quick" : "from-" + name_of(request.method));
  words.insert(words.end(), sources.begin(), sources.end());
  const std::string found = folder + kHandFound + "/";
  if (!request.known.is_empty()) add("--known", folder + kHandKnown);
  if (is_quick) {
    add("--population", request.population);
    if (!sources.empty()) {
      add("--sheet", request.sheet);
      if (request.wrist_inside != 0.0)
        add("--wrist-inside-mm", formats::shortest(request.wrist_inside));
      if (request.is_palm_up) words.emplace_back("--palm-up");
      add("--picture", found + "found.png");
    }
    words.emplace_back("--json");
  } else {
    if (request.method != HandMethod::kMri) {
      add("--crease-colour", request.crease_colour);
      add("--dot-colour", request.dot_colour);
    }
    if (request.method == HandMethod::kScan && request.unit) add("--unit", name_of(*request.unit));
    add("--language", language);
    add("--work", folder + kHandFound);
  }
  add("--out", folder + hand_result(request, sources).string());
  return words;
}

std::vector<std::string> hand_sources(HandMethod method, const std::vector<std::string>& files) {
  const auto with = [&](const std::vector<std::string>& endings) {
    std::vector<std::string> chosen;
    for (const std::string& file : files) {
      const std::string ending = lower_ending(file);
      if (std::find(endings.begin(), endings.end(), ending) != endings.end()) {
        chosen.push_back(file);
      }
    }
    return chosen;
  };
  switch (method) {
    case HandMethod::kFile:
      return with({".glb"});
    case HandMethod::kQuick:
      return with({".png", ".jpg", ".jpeg"});
    case HandMethod::kScan:
      return with({".obj", ".ply", ".glb", ".gltf", ".stl"});
    case HandMethod::kPhotos:
      return {""};
    case HandMethod::kMri: {
      auto images = with({".nii", ".gz"});
      return images.empty() ? std::vector<std::string>{""} : images;
    }
  }
  return {};
}

std::optional<std::string> known_source(const std::vector<std::string>& files) {
  std::optional<std::string> known;
  for (const std::string& file : files) {
    if (lower_ending(file) != ".toml") continue;
    if (known) {
      throw UsageError("hand: " + formats::in_quotes(*known) + " and " + formats::in_quotes(file) +
                       " were sent; one file says what is known of a person");
    }
    known = file;
  }
  return known;
}

}  // namespace palmar::server
