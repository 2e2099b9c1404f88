// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "peoples_holds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/formats/toml_section.h"
#include "palmar/hand/skeleton.h"

namespace palmar::tests {
namespace {

constexpr double kHoldDeg = std::numbers::pi / 180.0;

// Names of grips by family; those that Palmar doesn't have (yet) stand with the taxonomy's name.
const std::map<std::string, std::vector<std::string>>& grip_families() {
  static const std::map<std::string, std::vector<std::string>> families = {
      {"power",
       {"medium_wrap", "large_diameter", "small_diameter", "adducted_thumb", "light_tool",
        "index_finger_extension"}},
      {"hook", {"fixed_hook"}},
      {"loop", {"loop", "loop_grip"}},
      {"sphere", {"power_sphere", "power_disk", "sphere_4_finger"}},
      {"precision_sphere", {"precision_sphere", "precision_disk"}},
      {"prismatic",
       {"prismatic_2_finger", "prismatic_3_finger", "prismatic_4_finger", "prismatic"}},
      {"pinch", {"tip_pinch", "palmar_pinch"}},
      {"tripod", {"tripod", "writing_tripod"}},
      {"lateral", {"lateral", "lateral_tripod"}},
      {"plate", {"extension_type", "parallel_extension", "plate"}},
      {"ring", {"distal_type", "scissors", "ring"}},
      {"rest", {"rest", "relaxed", "resting_hand", "flat_hand"}},
      {"push", {"finger_push"}},
  };
  return families;
}

Vec3 vector_of(const toml::array& values, const std::string& where) {
  Vec3 v = Vec3::Zero();
  for (int a = 0; a < 3; ++a) {
    const auto value = values.size() == 3 ? values[a].value<double>() : std::nullopt;
    if (!value) throw InputError(where + " must be three numbers");
    v[a] = *value;
  }
  return v;
}

// Three numbers, or a list of such; nothing where the key is missing.
std::vector<Vec3> vectors_of(const toml::table& entry, const std::string& key,
                             const std::string& where) {
  const toml::array* values = entry[key].as_array();
  if (values == nullptr) return {};
  std::vector<Vec3> list;
  if (!values->empty() && (*values)[0].is_array()) {
    for (const toml::node& one : *values) {
      if (!one.is_array()) throw InputError(where + ", " + key + " must be lists of three numbers");
      list.push_back(vector_of(*one.as_array(), where + ", " + key));
    }
  } else {
    list.push_back(vector_of(*values, where + ", " + key));
  }
  return list;
}

std::vector<Box3> boxes_of(const toml::table& entry, const std::string& key,
                           const std::string& where) {
  const std::vector<Vec3> from = vectors_of(entry, key + "_from_mm", where);
  const std::vector<Vec3> to = vectors_of(entry, key + "_to_mm", where);
  if (from.size() != to.size()) throw InputError(where + ": boxes of " + key + " lack a corner");
  std::vector<Box3> boxes;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if ((from[i].array() > to[i].array()).any()) {
      throw InputError(where + ": a box of " + key + " is turned inside out");
    }
    boxes.emplace_back(from[i], to[i]);
  }
  return boxes;
}

// Least angle to one of the directions, rad.
double angle_to(const std::vector<Vec3>& directions, const Vec3& v) {
  double least = std::numbers::pi;
  for (const Vec3& d : directions) {
    least = std::min(least, std::acos(std::clamp(d.normalized().dot(v.normalized()), -1.0, 1.0)));
  }
  return least;
}

bool is_round_grip(grasp::Grip grip) {
  return is_of_family(grip, "sphere") || is_of_family(grip, "precision_sphere");
}

}  // namespace

bool is_of_family(grasp::Grip grip, const std::string& family) {
  const auto found = grip_families().find(family);
  if (found == grip_families().end()) {
    throw UsageError("family of grips \"" + family + "\" is not known");
  }
  const std::string name(name_of(grip));
  return std::find(found->second.begin(), found->second.end(), name) != found->second.end();
}

std::vector<PeoplesHold> read_peoples_holds(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw InputError(file.string() + " can't be read");
  const toml::table all = formats::parse_toml(text.str(), file.string());
  const formats::TomlSection section(file.string(), "", all);
  section.allow({"hold"});
  std::vector<PeoplesHold> list;
  for (const formats::TomlSection& entry : section.tables("hold")) {
    entry.allow({"product", "use", "part", "grips", "centre_from_mm", "centre_to_mm",
                 "thumb_toward", "palm_faces", "palm_within_deg", "fingers_toward",
                 "index_fingertip_from_mm", "index_fingertip_to_mm", "source"});
    PeoplesHold hold;
    hold.product = entry.need_text("product");
    const std::string where = file.filename().string() + ": " + hold.product;
    hold.use = entry.need_text("use");
    hold.part = entry.need_text("part");
    entry.need_text("source");
    hold.grips = entry.texts("grips");
    if (hold.grips.empty()) throw InputError(where + " has no grips");
    for (const std::string& family : hold.grips) is_of_family(grasp::Grip::kMediumWrap, family);
    hold.centre = boxes_of(entry.values(), "centre", where);
    if (hold.centre.empty()) throw InputError(where + " has no box of the centre");
    hold.thumb_toward = vectors_of(entry.values(), "thumb_toward", where);
    hold.palm_faces = vectors_of(entry.values(), "palm_faces", where);
    hold.palm_within = kHoldDeg * entry.number("palm_within_deg", "deg", 0.0, 180.0).value_or(60.0);
    hold.fingers_toward = vectors_of(entry.values(), "fingers_toward", where);
    const std::vector<Box3> index = boxes_of(entry.values(), "index_fingertip", where);
    if (!index.empty()) hold.index_fingertip = index.front();
    list.push_back(std::move(hold));
  }
  return list;
}

Vec3 centre_of(const grasp::RankedHold& found) {
  const grasp::Grasp& grasp = found.grasp;
  if (grasp::is_power(grasp.grip) || grasp.fingertips.empty()) return grasp.grip_point;
  // Between the thumb and the middle of the others, which press against each other as one (virtual
  // fingers: Iberall 1997, Int J Robotics Research 16:285-299).
  const auto count = static_cast<double>(grasp.fingertips.size());
  Vec3 mean = Vec3::Zero(), others = Vec3::Zero();
  std::optional<Vec3> thumb;
  for (const grasp::FingertipContact& tip : grasp.fingertips) {
    mean += tip.target / count;
    if (tip.finger == hand::Finger::kThumb) {
      thumb = tip.target;
    } else {
      others += tip.target / std::max(1.0, count - 1.0);
    }
  }
  return thumb && count > 1.0 && !grasp::is_non_prehensile(grasp.grip)
             ? Vec3(0.5 * (*thumb + others))
             : mean;
}

Vec3 index_fingertip(const hand::Hand& hand, const grasp::RankedHold& found) {
  const hand::PosedSkeleton pose = hand::pose_skeleton(hand.skeleton, found.grasp.posture);
  return found.grasp.product_from_hand *
         (pose.segment[static_cast<std::size_t>(hand::Segment::kIndexDistal)] *
          hand.skeleton.fingertips[static_cast<std::size_t>(hand::Finger::kIndex)]);
}

std::string objection(const PeoplesHold& people, const grasp::RankedHold& found) {
  const grasp::Grip grip = found.hold.grip;
  const bool is_their_grip =
      std::any_of(people.grips.begin(), people.grips.end(),
                  [&](const std::string& family) { return is_of_family(grip, family); });
  std::vector<std::string> list;
  if (!is_their_grip) list.push_back("the grip is " + std::string(name_of(grip)));
  const Vec3 centre = centre_of(found);
  double outside = 1e9;  // mm
  for (const Box3& box : people.centre) outside = std::min(outside, box.exteriorDistance(centre));
  if (outside > 0.0) {
    list.push_back(fmt::format("its centre ({:.0f}, {:.0f}, {:.0f}) is {:.0f} mm off", centre.x(),
                               centre.y(), centre.z(), outside));
  }
  const auto direction = [&](const std::vector<Vec3>& wanted, const Vec3& v, double within,
                             const char* what) {
    if (wanted.empty()) return;
    const double angle = angle_to(wanted, v);
    if (angle > within) list.push_back(fmt::format("{} {:.0f} deg off", what, angle / kHoldDeg));
  };
  // A round grip has no axis.
  if (!is_round_grip(grip)) {
    direction(people.thumb_toward, found.grasp.grip_axis, 60.0 * kHoldDeg, "the thumb's side is");
  }
  // The hand's frame: z is palmar, y distal (power/placement.h); the same in a left hand.
  const Quat& turn = found.grasp.product_from_hand.rotation;
  direction(people.palm_faces, turn * Vec3::UnitZ(), people.palm_within, "the palm is");
  direction(people.fingers_toward, turn * Vec3::UnitY(), 60.0 * kHoldDeg, "the fingers are");
  std::string text;
  for (const std::string& one : list) text += (text.empty() ? "" : ", ") + one;
  return text;
}

std::string objection(const std::vector<PeoplesHold>& people, const grasp::RankedHold& found) {
  std::string text;
  for (const PeoplesHold& way : people) {
    const std::string one = objection(way, found);
    if (one.empty()) return "";
    text += (text.empty() ? "" : "; or ") + one + " (" + way.part + ")";
  }
  return text;
}

}  // namespace palmar::tests
