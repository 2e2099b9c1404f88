// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/hand_profile.h"

#include <cmath>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "palmar/hand/posture/named_postures.h"

namespace palmar::population {
namespace {

// The limit posture of the thumb that a range now ends at: that share of the old limit's rotation
// vector and translation.
hand::CmcLimit part_of(const hand::CmcLimit& limit, double share) {
  const Eigen::AngleAxisd turn(limit.q);
  return {Quat(Eigen::AngleAxisd(share * turn.angle(), turn.axis())), share * limit.t};
}

// What is left of the way from the reference to a limit; nothing if the limit or the new range's
// end lies on the other side of the reference, where this limit posture has no part.
double share_left(double reference, double before, double after, double sign) {
  const double whole = sign * (before - reference), left = sign * (after - reference);
  return whole > 0.0 && left > 0.0 ? left / whole : 1.0;
}

void scale(std::vector<Vec3>& coefficients, double share) {
  for (Vec3& one : coefficients) one *= share;
}

void move_thumb_limits(const hand::Skeleton& before, hand::Hand& hand) {
  const auto share = [&](hand::Dof dof, bool is_upper) {
    const hand::JointDof& old_dof = before.dof(dof);
    const hand::JointDof& new_dof = hand.skeleton.dof(dof);
    return is_upper ? share_left(old_dof.reference, old_dof.upper, new_dof.upper, 1.0)
                    : share_left(old_dof.reference, old_dof.lower, new_dof.lower, -1.0);
  };
  const double flexion = share(hand::Dof::kThumbCmcFlexion, true);
  const double extension = share(hand::Dof::kThumbCmcFlexion, false);
  const double abduction = share(hand::Dof::kThumbCmcAbduction, true);
  const double adduction = share(hand::Dof::kThumbCmcAbduction, false);
  hand::ThumbCmc& cmc = hand.skeleton.thumb_cmc;
  cmc = {.flexion = part_of(cmc.flexion, flexion),
         .extension = part_of(cmc.extension, extension),
         .abduction = part_of(cmc.abduction, abduction),
         .adduction = part_of(cmc.adduction, adduction)};
  // The correction of the thumb ball is added by the same shares of the same limit postures.
  auto& coefficient = hand.thumb_ball.coefficient;
  scale(coefficient[0], flexion);
  scale(coefficient[1], extension);
  scale(coefficient[2], abduction);
  scale(coefficient[3], adduction);
}

std::vector<HandProfile> make_profiles() {
  std::vector<HandProfile> list;
  const auto add = [&](HandProfile profile) { list.push_back(std::move(profile)); };
  add({.name = "none", .source = "the population as it is"});
  add({.name = "reduced_range",
       .range_share = 0.56,
       .source = "range that serves 90 % of 20 activities: MCP 52 of 108, PIP 64 of 108, DIP 54 of "
                 "90 deg, mean 56 % (J Hand Surg Eur 2015, 40:406-411, abstract)"});
  add({.name = "reduced_strength",
       .strength_share = 0.65,
       .source = "Germans of 80-90 against 30-34 years: men 34.0 / 53.5 kg, women 22.1 / 33.7 kg "
                 "(Steiber 2016, PLoS ONE 11:e0163917)"});
  add({.name = "arthritis",
       .range_share = 0.56,
       .strength_share = 0.56,
       .source = "grip force of 215 people five years into rheumatoid arthritis, 56 % of expected "
                 "(Rydholm et al. 2023, Arthritis Res Ther, abstract); range as reduced_range, a "
                 "choice"});
  add({.name = "thin_gloves",
       .strength_share = 0.9,
       .glove_thickness = 1.0,
       .source = "strength: the best of two gloves that don't damp vibration lost less than 10 % "
                 "(McDowell et al., NIOSH, abstract); thickness and stiffness are choices"});
  add({.name = "thick_gloves",
       .strength_share = 0.71,
       .glove_thickness = 3.0,
       .source = "strength: gloves against vibration lost more than 29 % (McDowell et al., NIOSH, "
                 "abstract); thickness and stiffness are choices"});
  add({.name = "long_nails", .nail_length = 5.0, .source = "a choice"});
  constexpr const char* kGrowth =
      ": stature of boys against men of 19 years (WHO growth reference 2007, medians), hand in "
      "proportion to it, a choice; grip strength of English schoolboys (Cohen et al. 2010) against "
      "men of 30-34 years (Steiber 2016). For a population of men";
  add({.name = "child_10",
       .strength_share = 0.31,
       .size_factor = 0.78,
       .source = "137.8 / 176.5 cm, 16.7 / 53.5 kg" + std::string(kGrowth)});
  add({.name = "child_12",
       .strength_share = 0.42,
       .size_factor = 0.84,
       .source = "149.1 / 176.5 cm, 22.7 / 53.5 kg" + std::string(kGrowth)});
  add({.name = "child_14",
       .strength_share = 0.61,
       .size_factor = 0.92,
       .source = "163.2 / 176.5 cm, 32.5 / 53.5 kg" + std::string(kGrowth)});
  return list;
}

}  // namespace

void HandProfile::check() const {
  const auto require = [&](bool is_allowed, const char* field, double value, const char* allowed) {
    if (is_allowed) return;
    std::ostringstream text;
    text << "profile \"" << name << "\": " << field << " is " << value << "; " << allowed
         << " is allowed";
    throw UsageError(text.str());
  };
  if (name.empty()) throw UsageError("a profile has no name; a word is required");
  require(range_share > 0.0 && range_share <= 1.0, "range_share", range_share, "above 0 to 1");
  require(strength_share > 0.0 && strength_share <= 1.0, "strength_share", strength_share,
          "above 0 to 1");
  require(glove_thickness == 0.0 || (glove_thickness >= 0.05 && glove_thickness <= 20.0),
          "glove_thickness", glove_thickness, "0 or 0.05 to 20 mm");
  require(glove_shear_modulus >= 1e-4 && glove_shear_modulus <= 1e5, "glove_shear_modulus",
          glove_shear_modulus, "0.0001 to 100000 MPa");
  require(nail_length >= 0.0 && nail_length <= 50.0, "nail_length", nail_length, "0 to 50 mm");
  require(size_factor >= 0.4 && size_factor <= 1.5, "size_factor", size_factor, "0.4 to 1.5");
}

const std::vector<HandProfile>& built_in_profiles() {
  static const std::vector<HandProfile> list = make_profiles();
  return list;
}

const HandProfile& profile_named(const std::string& name) {
  std::vector<std::string> names;
  for (const HandProfile& profile : built_in_profiles()) {
    if (profile.name == name) return profile;
    names.push_back(profile.name);
  }
  throw UsageError("profile \"" + name + "\" is not known; " +
                   did_you_mean(name, names, "built in are " + joined(names, ", ")));
}

hand::Hand with_range_share(const hand::Hand& hand, double range_share) {
  if (!(range_share > 0.0 && range_share <= 1.0)) {
    std::ostringstream text;
    text << "share of the range of motion is " << range_share << "; above 0 to 1 is allowed";
    throw UsageError(text.str());
  }
  hand::Hand reduced = hand;
  if (range_share == 1.0) return reduced;
  const hand::Posture relaxed = hand::named_posture(hand.skeleton, "relaxed").value();
  for (hand::Joint& joint : reduced.skeleton.joints) {
    for (hand::JointDof& dof : joint.dofs) {
      const double middle = relaxed[dof.dof];
      dof.lower = middle + range_share * (dof.lower - middle);
      dof.upper = middle + range_share * (dof.upper - middle);
    }
  }
  move_thumb_limits(hand.skeleton, reduced);
  return reduced;
}

HandSample with_profile(const HandSample& sample, const HandProfile& profile) {
  profile.check();
  HandSample changed = sample;
  for (hand::SizedDimension& one : changed.dimensions) one.value *= profile.size_factor;
  changed.grip_strength *= profile.strength_share;
  return changed;
}

hand::Hand with_profile(const hand::Hand& hand, const HandProfile& profile) {
  profile.check();
  return with_range_share(
      profile.size_factor == 1.0 ? hand : hand::scaled(hand, profile.size_factor),
      profile.range_share);
}

}  // namespace palmar::population
