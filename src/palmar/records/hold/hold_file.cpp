// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hold/hold_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "palmar/core/nearest_name.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/formats/toml_section.h"
#include "palmar/geometry/degrees.h"

namespace palmar::records {
namespace {

constexpr std::uint64_t kMostHoldBytes = 1 << 16;  // a hold of five fingertips has 1 kB
constexpr int kMostParts = 10'000;
constexpr double kMostTurn = 360.0;     // deg, either way
constexpr double kMostHeight = 5000.0;  // mm; fingertips are at most so far from a centre line
constexpr double kFarthest = 100.0;     // lengths of the part, on its lengthened ends

const char* const kHeader =
    "# How people take hold of a product: by which part of it, in which grip, where along it\n"
    "# and how turned about it; the same for hands of every size and for both sides.\n"
    "# palmar assess PRODUCT --hold FILE takes it. docs/using/holds.md says what the keys mean.\n";

grasp::Grip read_grip(const formats::TomlSection& section) {
  const std::string name = section.need_text("grip");
  if (const std::optional<grasp::Grip> grip = grasp::grip_named(name)) return *grip;
  std::vector<std::string> known;
  std::string list;
  for (int g = 0; g < grasp::kGripCount; ++g) {
    known.emplace_back(name_of(static_cast<grasp::Grip>(g)));
    list += (list.empty() ? "" : ", ") + known.back();
  }
  const std::string nearest = nearest_name(name, known);
  section.fail("grip", fmt::format("is \"{}\", which is not known{}; {} is allowed", name,
                                   nearest.empty() ? "" : ", did you mean " + nearest + "?", list));
}

grasp::HoldFingertip read_fingertip(const formats::TomlSection& section) {
  section.allow({"finger", "along", "turn_deg", "height_mm"});
  const std::string name = section.need_text("finger");
  const std::optional<hand::Finger> finger = hand::finger_named(name);
  if (!finger) {
    section.fail("finger", fmt::format("is \"{}\", which is not known; thumb, index, middle, ring "
                                       "or little is allowed",
                                       name));
  }
  grasp::HoldFingertip tip;
  tip.finger = *finger;
  tip.place.along = section.need_number("along", "", -kFarthest, kFarthest);
  tip.place.turn =
      geometry::kDegree * section.need_number("turn_deg", "deg", -kMostTurn, kMostTurn);
  tip.place.height = section.need_number("height_mm", "mm", -kMostHeight, kMostHeight);
  return tip;
}

void check_fingertips(const formats::TomlSection& file, const grasp::Hold& hold) {
  const bool needs_tips = !grasp::is_power(hold.grip) && !grasp::is_laid(hold.grip);
  if (needs_tips && hold.fingertips.empty()) {
    file.fail("grip", fmt::format("is {}, which holds with fingertips; a "
                                  "[[fingertip]] is required for each finger",
                                  name_of(hold.grip)));
  }
  if (!needs_tips && !hold.fingertips.empty()) {
    file.fail("fingertip",
              fmt::format("goes with grips of fingertips only; {} holds with the whole "
                          "hand",
                          name_of(hold.grip)));
  }
  std::set<hand::Finger> seen;
  for (const grasp::HoldFingertip& tip : hold.fingertips) {
    if (!seen.insert(tip.finger).second) {
      file.fail("fingertip",
                fmt::format("gives {} twice; once per finger is allowed", name_of(tip.finger)));
    }
  }
}

/// A direction of the product's frame, as a unit vector.
std::optional<Vec3> read_direction(const formats::TomlSection& file, const char* key) {
  if (!file.has(key)) return std::nullopt;
  const std::vector<double> numbers = file.numbers(key, "", -kMostHeight, kMostHeight);
  if (numbers.size() != 3) {
    file.fail(key, fmt::format("has {} numbers; three, of a direction in the product's frame, are "
                               "required",
                               numbers.size()));
  }
  const Vec3 direction(numbers[0], numbers[1], numbers[2]);
  if (direction.norm() < 1e-9) {
    file.fail(key, "has no direction; three numbers, not all 0, are required");
  }
  // What is a unit vector already stays as it is, to the last digit.
  return std::abs(direction.norm() - 1.0) < 1e-12 ? direction : Vec3(direction.normalized());
}

void read_directions(const formats::TomlSection& file, grasp::Hold& hold) {
  hold.wrist = read_direction(file, "wrist");
  if (hold.wrist && hold.fingertips.empty()) {
    file.fail("wrist", "goes with grips of fingertips only; turn_deg says where the palm lies");
  }
  const std::optional<Vec3> along = read_direction(file, "along_toward");
  const std::optional<Vec3> zero = read_direction(file, "turn_from");
  if (along.has_value() != zero.has_value()) {
    file.fail(
        along ? "along_toward" : "turn_from",
        fmt::format("stands alone; {} is required, too", along ? "turn_from" : "along_toward"));
  }
  if (along) hold.anchor = {*along, *zero};
}

std::string direction_line(const char* key, const Vec3& direction, const char* words) {
  return fmt::format("{} = [{}, {}, {}]  # {}\n", key, formats::toml_number(direction.x()),
                     formats::toml_number(direction.y()), formats::toml_number(direction.z()),
                     words);
}

/// Degrees that read back to an angle, with as few digits as say so; 45.0 for pi / 4.
std::string degrees_text(double angle) {
  const double about = angle * geometry::kDegreesPerRadian;
  for (const int digits : {12, 15}) {
    const double rounded =
        formats::parse_double(fmt::format("{:.{}g}", about, digits)).value_or(about);
    if (rounded * geometry::kDegree == angle) return formats::toml_number(rounded);
  }
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const double up = std::nextafter(about, kEndless), down = std::nextafter(about, -kEndless);
  for (const double near : {about, up, down}) {
    if (near * geometry::kDegree == angle) return formats::toml_number(near);
  }
  return formats::toml_number(about);
}

}  // namespace

HoldFile read_hold(const std::string& path) {
  const toml::table table = formats::parse_toml(formats::read_file(path, kMostHoldBytes), path);
  const formats::TomlSection file(path, "", table);
  file.allow({"version", "product", "part", "part_name", "grip", "along", "edge", "toward",
              "turn_deg", "over_end", "wrist", "along_toward", "turn_from", "fingertip"});
  // A newer file may hold more than this program knows, so its version is looked at first.
  const auto version = file.integer("version", 1, std::numeric_limits<std::int64_t>::max());
  if (version.value_or(1) > kHoldFileVersion) {
    file.fail("version", fmt::format("is {}; this program reads up to version {} (a newer Palmar "
                                     "wrote it)",
                                     *version, kHoldFileVersion));
  }
  HoldFile result;
  result.product = file.text("product").value_or("");
  grasp::Hold& hold = result.hold;
  const auto part = file.integer("part", 1, kMostParts);
  if (!part) file.fail("key \"part\" is missing; the number of the part that is held is required");
  hold.part = static_cast<int>(*part);
  hold.part_name = file.text("part_name").value_or("");
  hold.grip = read_grip(file);
  hold.along = file.need_number("along", "", 0.0, 1.0);
  hold.edge = file.number("edge", "", -0.5, 0.5).value_or(0.0);
  if (const auto toward = file.integer("toward", -1, 1)) {
    if (*toward == 0) file.fail("toward", "is 0; 1 or -1 is allowed");
    hold.toward = static_cast<int>(*toward);
  }
  hold.turn =
      geometry::kDegree * file.number("turn_deg", "deg", -kMostTurn, kMostTurn).value_or(0.0);
  hold.is_over_end = file.boolean("over_end").value_or(false);
  for (const formats::TomlSection& tip : file.tables("fingertip")) {
    hold.fingertips.push_back(read_fingertip(tip));
  }
  check_fingertips(file, hold);
  read_directions(file, hold);
  return result;
}

std::string hold_toml(const HoldFile& file) {
  const grasp::Hold& hold = file.hold;
  std::string text = kHeader;
  text += fmt::format("version = {}\n", kHoldFileVersion);
  if (!file.product.empty()) {
    text += fmt::format("product = {}  # for information\n", formats::toml_string(file.product));
  }
  text += fmt::format("part = {}  # its number; palmar product parts lists them\n", hold.part);
  if (!hold.part_name.empty()) {
    text +=
        fmt::format("part_name = {}  # for information\n", formats::toml_string(hold.part_name));
  }
  text += fmt::format("grip = {}\n", formats::toml_string(std::string(name_of(hold.grip))));
  text += fmt::format("along = {}  # where on the part, a fraction of its length\n",
                      formats::toml_number(hold.along));
  text += fmt::format(
      "edge = {}  # what of the hand is there: 0 the middle of the fingers, 0.5 the\n"
      "            # index finger's outer edge, -0.5 the little finger's\n",
      formats::toml_number(hold.edge));
  text += fmt::format(
      "toward = {}  # the thumb's side points to growing along (1) or to where it starts (-1)\n",
      hold.toward);
  text += fmt::format("turn_deg = {}  # where the palm lies, about the part's axis\n",
                      degrees_text(hold.turn));
  text += fmt::format("over_end = {}  # the palm lies over the end of the part\n",
                      hold.is_over_end ? "true" : "false");
  if (hold.wrist) {
    text += direction_line("wrist", *hold.wrist,
                           "from the fingertips' middle to the wrist, the product's frame");
  }
  if (hold.anchor) {
    text += direction_line("along_toward", hold.anchor->along, "where along grows; these two make");
    text += direction_line("turn_from", hold.anchor->zero, "the hold the same on another version");
  }
  for (const grasp::HoldFingertip& tip : hold.fingertips) {
    text += fmt::format("\n[[fingertip]]\nfinger = {}\nalong = {}\nturn_deg = {}\nheight_mm = {}\n",
                        formats::toml_string(std::string(name_of(tip.finger))),
                        formats::toml_number(tip.place.along), degrees_text(tip.place.turn),
                        formats::toml_number(tip.place.height));
  }
  return text;
}

void write_hold(const std::string& path, const HoldFile& file) {
  formats::write_file(path, hold_toml(file));
}

}  // namespace palmar::records
