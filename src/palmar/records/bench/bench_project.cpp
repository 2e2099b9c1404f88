// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/bench/bench_project.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/degrees.h"
#include "palmar/records/posture/placement_json.h"

namespace palmar::records {
namespace {

using BenchJson = nlohmann::json;

constexpr int kBenchProjectVersion = 1;
constexpr int kMostHoldNumber = 1000;     // as the live channel takes them
constexpr double kMostBenchForce = 2000;  // N, as above
constexpr std::size_t kLongestShown = 60;

[[noreturn]] void refuse_member(const char* name, const BenchJson& value,
                                const std::string& required) {
  std::string shown = value.dump(-1, ' ', false, BenchJson::error_handler_t::replace);
  if (shown.size() > kLongestShown) shown = shown.substr(0, kLongestShown) + "...";
  throw InputError(std::string("\"") + name + "\" is " + shown + "; " + required + " is required");
}

const BenchJson& needed(const BenchJson& json, const char* name, const std::string& required) {
  const auto found = json.find(name);
  if (found == json.end()) {
    throw InputError(std::string("\"") + name + "\" is missing; " + required + " is required");
  }
  return *found;
}

const BenchJson& object_in(const BenchJson& json, const char* name) {
  const BenchJson& value = needed(json, name, "an object");
  if (!value.is_object()) refuse_member(name, value, "an object");
  return value;
}

std::string text_in(const BenchJson& json, const char* name) {
  const BenchJson& value = needed(json, name, "a text");
  if (!value.is_string()) refuse_member(name, value, "a text");
  return value.get<std::string>();
}

/// "" for null.
std::string text_or_null_in(const BenchJson& json, const char* name) {
  return needed(json, name, "a text or null").is_null() ? "" : text_in(json, name);
}

int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// RFC 4648, section 4.
std::string from_base64(std::string_view text) {
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  bool is_valid = text.size() % 4 == 0 && !text.empty();
  text.remove_suffix(padding);
  std::string bytes;
  bytes.reserve(3 * text.size() / 4);
  unsigned held = 0;
  int bits = 0;
  for (const char c : text) {
    const int value = base64_value(c);
    is_valid = is_valid && value >= 0;
    if (!is_valid) break;
    held = (held << 6U) | static_cast<unsigned>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>((held >> static_cast<unsigned>(bits)) & 0xffU);
  }
  if (!is_valid) throw InputError("\"bytes_base64\" is no base64 (RFC 4648)");
  return bytes;
}

BenchPose bench_pose(const BenchJson& json) {
  if (!json.is_object()) refuse_member("pose", json, "an object or null");
  const std::string required =
      "a list of " + std::to_string(hand::kDofCount) + " angles in degrees";
  const BenchJson& angles = needed(json, "posture_deg", required);
  if (!angles.is_array() || angles.size() != hand::kDofCount) {
    refuse_member("posture_deg", angles, required);
  }
  BenchPose pose;
  for (std::size_t k = 0; k < hand::kDofCount; ++k) {
    const double angle = angles[k].is_number() ? angles[k].get<double>() : NAN;
    if (!(std::abs(angle) <= 360.0)) {
      refuse_member("posture_deg", angles[k], "an angle within a full turn");
    }
    pose.posture.angle[k] = geometry::kDegree * angle;
  }
  pose.product_from_hand = placement_from_json(json);
  const std::string grip = text_in(json, "grip");
  pose.grip = grasp::grip_named(grip);
  if (!pose.grip) refuse_member("grip", json["grip"], "a grip's name");
  return pose;
}

std::string bench_file_name(const BenchJson& product) {
  const std::string name = text_in(product, "file_name");
  const bool has_control =
      std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (name.empty() || name.front() == '.' || name.find_first_of("/\\") != name.npos ||
      has_control) {
    refuse_member("file_name", product["file_name"], "a file's name without folders");
  }
  return name;
}

}  // namespace

BenchProject parse_bench_project(std::string_view text) {
  BenchJson json;
  try {
    json = BenchJson::parse(text);
  } catch (const BenchJson::exception& error) {
    throw InputError(formats::json_reason(error));
  }
  if (!json.is_object()) throw InputError("it is no project of the workbench: no JSON object");
  const std::string required = std::to_string(kBenchProjectVersion) + " (its version)";
  const BenchJson& version = needed(json, "palmar_project", required);
  if (version != kBenchProjectVersion) refuse_member("palmar_project", version, required);

  BenchProject project;
  const BenchJson& product = object_in(json, "product");
  project.file_name = bench_file_name(product);
  const std::string unit = text_or_null_in(product, "unit");
  try {
    if (!unit.empty()) project.unit = geometry::length_unit(unit);
  } catch (const UsageError& error) {
    throw InputError(std::string("\"unit\": ") + error.what());
  }
  project.bytes = from_base64(text_in(product, "bytes_base64"));
  const BenchJson& hand = object_in(json, "hand");
  project.person = text_or_null_in(hand, "person");
  if (hand.contains("file") && !hand["file"].is_null()) {
    const BenchJson& file = object_in(hand, "file");
    project.hand_file = bench_file_name(file);
    project.hand_bytes = from_base64(text_in(file, "bytes_base64"));
    if (!project.person.empty()) refuse_member("person", hand["person"], "null beside a file");
  }
  const BenchJson& left = needed(hand, "left", "true or false");
  if (!left.is_boolean()) refuse_member("left", left, "true or false");
  project.is_left = left.get<bool>();
  const BenchJson& force = needed(json, "grip_force_n", "a number or null");
  if (!force.is_null()) {
    const double value = force.is_number() ? force.get<double>() : NAN;
    if (!(value > 0.0 && value <= kMostBenchForce)) {
      refuse_member("grip_force_n", force, "a number above 0 up to 2000, or null");
    }
    project.grip_force = value;
  }
  const std::string numbers = "a whole number from 1 to " + std::to_string(kMostHoldNumber);
  const BenchJson& hold = needed(json, "hold", numbers);
  if (!hold.is_number_integer() || hold.get<double>() < 1 || hold.get<double>() > kMostHoldNumber) {
    refuse_member("hold", hold, numbers);
  }
  project.hold = hold.get<int>();
  const BenchJson& pose = needed(json, "pose", "an object or null");
  if (!pose.is_null()) project.pose = bench_pose(pose);
  const std::string settle = text_or_null_in(json, "settle");
  if (settle == "close") {
    project.settle = BenchSettle::kClose;
  } else if (settle == "rest") {
    project.settle = BenchSettle::kRest;
  } else if (!settle.empty()) {
    refuse_member("settle", json["settle"], "close, rest or null");
  }
  return project;
}

BenchProject read_bench_project(const std::filesystem::path& file) {
  const std::string text = formats::read_file(file);
  try {
    return parse_bench_project(text);
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

}  // namespace palmar::records
