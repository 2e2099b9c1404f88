// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tissue.h"

#include <array>
#include <cmath>
#include <sstream>

#include "palmar/core/enum_index.h"

namespace palmar::hand {
namespace {

constexpr std::array<std::string_view, kTissueClassCount> kClassNames = {"finger", "palm",
                                                                         "dorsum"};

constexpr const char* kHalfSpaceSource =
    "half-space and bulge: Xie 2014, eq. 3-3, Table 3-2, fig. 3-9; nominal is the middle of the "
    "ranges given for G0 and G_lim, low and high are their ends";

/// First fault of a law, or "".
std::string fault_of(const StiffeningLaw& law, const std::string& name) {
  std::ostringstream text;
  const auto modulus = [&](const char* what, double value) {
    if (value >= kMinShearModulus && value <= kMaxShearModulus) return true;
    text << name << ": " << what << " is " << 1000.0 * value << " kPa; "
         << 1000.0 * kMinShearModulus << " to " << 1000.0 * kMaxShearModulus << " kPa is allowed";
    return false;
  };
  if (!modulus("G0", law.g0) || !modulus("G_lim", law.g_limit)) return text.str();
  if (!(law.limit_depth > 0.0 && law.limit_depth <= kMaxTissueLength)) {
    text << name << ": limit depth is " << law.limit_depth << " mm; more than 0 and at most "
         << kMaxTissueLength << " mm is allowed";
  } else if (law.g_limit < law.g0) {
    text << name << ": G_lim is " << 1000.0 * law.g_limit << " kPa, below G0, " << 1000.0 * law.g0
         << " kPa; skin that softens with depth is not modelled";
  }
  return text.str();
}

std::string fault_of(const TissueStiffness& stiffness, const std::string& name) {
  for (const auto& [law, level] :
       {std::pair(&stiffness.nominal, " (nominal)"), std::pair(&stiffness.low, " (low)"),
        std::pair(&stiffness.high, " (high)")}) {
    if (std::string fault = fault_of(*law, name + level); !fault.empty()) return fault;
  }
  for (const auto& [what, value] :
       {std::pair("G0", &StiffeningLaw::g0), std::pair("G_lim", &StiffeningLaw::g_limit)}) {
    const double low = stiffness.low.*value;
    const double nominal = stiffness.nominal.*value;
    const double high = stiffness.high.*value;
    if (low <= nominal && nominal <= high) continue;
    std::ostringstream text;
    text << name << ": " << what << " is " << 1000.0 * low << ", " << 1000.0 * nominal << ", "
         << 1000.0 * high << " kPa (low, nominal, high); ascending values are required";
    return text.str();
  }
  return "";
}

}  // namespace

TissueClass tissue_class_of(Region region) {
  switch (region) {
    case Region::kDorsum:
      return TissueClass::kDorsum;
    case Region::kThenar:
    case Region::kHypothenar:
    case Region::kCentralPalm:
    case Region::kRadialPalm:
    case Region::kUlnarPalm:
      return TissueClass::kPalm;
    default:
      return TissueClass::kFinger;
  }
}

std::string_view name_of(TissueClass tissue) { return kClassNames[index_of(tissue)]; }

std::optional<TissueClass> tissue_class_named(std::string_view name) {
  for (std::size_t c = 0; c < kClassNames.size(); ++c) {
    if (kClassNames[c] == name) return static_cast<TissueClass>(c);
  }
  return std::nullopt;
}

RegionTissue finger_tissue() {
  return {.half_space = {.nominal = {0.005, 0.095, 4.0},
                         .low = {0.005, 0.070, 4.0},
                         .high = {0.005, 0.120, 4.0}},
          .layered = {.nominal = {0.0103, 0.0239, 4.0},
                      .low = {0.0090, 0.0202, 4.0},
                      .high = {0.0125, 0.0353, 4.0}},
          .on_bone = {.nominal = {0.0070, 15.0}, .low = {0.0059, 12.5}, .high = {0.0081, 16.5}},
          .swelling_height = 2.0,
          .swelling_radius = 8.0,
          .swelling_width = 2.0,
          .neighbourhood = 12.5,
          .source =
              std::string(kHalfSpaceSource) +
              "; width of the bulge (2 mm) assumed, the thesis' figure is lost; layered: fitted to "
              "the fingertip forces of the thesis' laws (radius 7.5 mm, 0.5-4 mm) on the "
              "template's middle fingertip against a plate at 30 deg; on bone: fitted to the same "
              "forces under its own law"};
}

RegionTissue palm_tissue() {
  return {
      .half_space = {.nominal = {0.0275, 0.060, 7.0},
                     .low = {0.005, 0.040, 7.0},
                     .high = {0.050, 0.080, 7.0}},
      .layered = {.nominal = {0.0185, 0.0230, 7.0},
                  .low = {0.0044, 0.0155, 7.0},
                  .high = {0.0305, 0.0310, 7.0}},
      .on_bone = {.nominal = {0.0174, 1.1}, .low = {0.0055, 5.0}, .high = {0.0287, 0.5}},
      .swelling_height = 3.0,
      .swelling_radius = 15.0,
      .swelling_width = 3.0,
      .neighbourhood = 17.5,
      .source = std::string(kHalfSpaceSource) +
                "; layered: gives the forces of those half-spaces on the template's thenar, "
                "hypothenar and the two pads against a plate (1-7 mm), as the thesis' test is "
                "not described well enough to repeat it: an assumption; on bone: gives the same "
                "forces under its own law, within 18 %: an assumption"};
}

RegionTissue dorsum_tissue() {
  RegionTissue tissue = finger_tissue();
  tissue.source = "assumed as the finger's: thin skin over bone or tendon; nothing measured";
  return tissue;
}

RegionTissue tissue_of(TissueClass tissue) {
  if (tissue == TissueClass::kPalm) return palm_tissue();
  return tissue == TissueClass::kDorsum ? dorsum_tissue() : finger_tissue();
}

Tissue default_tissue() {
  Tissue tissue;
  for (int r = 0; r < kRegionCount; ++r) {
    tissue.region[r] = tissue_of(tissue_class_of(static_cast<Region>(r)));
  }
  tissue.source = "Palmar's own set, from Xie 2014, chapter 3; see each region";
  return tissue;
}

std::string fault_of(const RegionTissue& tissue) {
  if (std::string fault = fault_of(tissue.half_space, "half-space"); !fault.empty()) return fault;
  if (std::string fault = fault_of(tissue.layered, "layered"); !fault.empty()) return fault;
  std::ostringstream text;
  for (const auto& [law, level] :
       {std::pair(&tissue.on_bone.nominal, "nominal"), std::pair(&tissue.on_bone.low, "low"),
        std::pair(&tissue.on_bone.high, "high")}) {
    if (!(law->g0 >= kMinShearModulus && law->g0 <= kMaxShearModulus)) {
      text << "on bone (" << level << "): G0 is " << 1000.0 * law->g0 << " kPa; "
           << 1000.0 * kMinShearModulus << " to " << 1000.0 * kMaxShearModulus << " kPa is allowed";
      return text.str();
    }
    if (!(law->stiffening >= 0.0 && law->stiffening <= kMostBoneStiffening)) {
      text << "on bone (" << level << "): stiffening is " << law->stiffening << "; 0 to "
           << kMostBoneStiffening << " is allowed";
      return text.str();
    }
  }
  if (!(tissue.on_bone.low.g0 <= tissue.on_bone.nominal.g0 &&
        tissue.on_bone.nominal.g0 <= tissue.on_bone.high.g0)) {
    text << "on bone: G0 is " << 1000.0 * tissue.on_bone.low.g0 << ", "
         << 1000.0 * tissue.on_bone.nominal.g0 << ", " << 1000.0 * tissue.on_bone.high.g0
         << " kPa (low, nominal, high); ascending values are required";
    return text.str();
  }
  if (!(tissue.poisson_layered >= 0.0 && tissue.poisson_layered <= 0.5)) {
    text << "Poisson's ratio of the layer is " << tissue.poisson_layered << "; 0 to 0.5 is allowed";
  }
  const auto length = [&](const char* name, double value, bool may_be_zero) {
    const bool is_allowed = value <= kMaxTissueLength && (may_be_zero ? value >= 0.0 : value > 0.0);
    if (is_allowed || text.tellp() > 0) return;
    text << name << " is " << value << " mm; "
         << (may_be_zero ? "0 to " : "more than 0 and at most ") << kMaxTissueLength
         << " mm is allowed";
  };
  length("height of the bulge", tissue.swelling_height, true);
  length("radius of the bulge", tissue.swelling_radius, false);
  length("width of the bulge", tissue.swelling_width, false);
  length("neighbourhood", tissue.neighbourhood, false);
  return text.str();
}

}  // namespace palmar::hand
