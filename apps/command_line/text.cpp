// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <vector>

#include "palmar/report/words/plain_words.h"
#include "plain_names.h"

namespace palmar::cli {

std::string volume_text(double volume, int digits) {
  const bool is_small = volume != 0.0 && std::abs(volume) < 10.0;
  return is_small ? fmt::format("{:.3g} mm3", volume) : fmt::format("{:.{}f} mm3", volume, digits);
}

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }
double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

std::string tissue_text(const hand::Tissue& tissue) {
  std::string text = "source: " + tissue.source + "\n";
  std::vector<bool> is_listed(hand::kRegionCount, false);
  for (std::size_t r = 0; r < hand::kRegionCount; ++r) {
    if (is_listed[r]) continue;
    const hand::RegionTissue& one = tissue.region[r];
    std::string names;
    for (std::size_t other = r; other < hand::kRegionCount; ++other) {
      if (is_listed[other] || tissue.region[other] != one) continue;
      is_listed[other] = true;
      names += (names.empty() ? "" : ", ") + std::string(name_of(static_cast<hand::Region>(other)));
    }
    text += "\n" + names + "\n";
    for (const auto& [model, stiffness] :
         {std::pair("half-space", &one.half_space), std::pair("layered", &one.layered)}) {
      const hand::StiffeningLaw &low = stiffness->low, &law = stiffness->nominal,
                                &high = stiffness->high;
      text += fmt::format(
          "  {:<11} G0 {:.4g} kPa ({:.4g} to {:.4g}), G_lim {:.4g} kPa ({:.4g} to {:.4g}) at "
          "{:.4g} mm\n",
          model, 1e3 * law.g0, 1e3 * low.g0, 1e3 * high.g0, 1e3 * law.g_limit, 1e3 * low.g_limit,
          1e3 * high.g_limit, law.limit_depth);
    }
    const hand::BoneTissue& bone = one.on_bone;
    text += fmt::format("  {:<11} G0 {:.4g} kPa ({:.4g} to {:.4g}), stiffening {:.4g}\n", "on bone",
                        1e3 * bone.nominal.g0, 1e3 * bone.low.g0, 1e3 * bone.high.g0,
                        bone.nominal.stiffening);
    text += fmt::format("  {:<11} {:g} mm high, {:g} mm from the contact, {:g} mm wide\n", "bulge",
                        one.swelling_height, one.swelling_radius, one.swelling_width);
    text += fmt::format("  {:<11} {}\n", "source", one.source);
  }
  return text;
}

std::string segments_text(const hand::HandDimensions& dimensions) {
  std::string text = fmt::format("{:<24} {:>7} {:>6} {:>10}  (mm)\n", "part of the hand", "length",
                                 "width", "thickness");
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const hand::SegmentDimensions& size = dimensions.segment[static_cast<std::size_t>(s)];
    text += fmt::format("{:<24} {:7.1f} {:6.1f} {:10.1f}\n",
                        report::plain_words(static_cast<hand::Segment>(s)), size.length, size.width,
                        size.thickness);
  }
  return text;
}

std::string hand_text(const hand::Hand& hand) {
  const hand::HandDimensions& d = hand.dimensions;
  std::string text = fmt::format(
      "{} ({} hand): {} vertices, {} triangles, {} bones\n"
      "  hand length L         {:7.1f} mm\n"
      "  hand circumference C  {:7.1f} mm\n"
      "  hand width W          {:7.1f} mm\n"
      "  hand thickness T      {:7.1f} mm\n\n",
      hand.name, name_of(hand.side), hand.skin.vertex_count(), hand.skin.triangle_count(),
      hand.bones.size(), d.hand_length, d.hand_circumference, d.hand_width, d.hand_thickness);
  text += segments_text(d);
  text += "\ndegree of freedom         range of motion   reference  (deg)\n";
  for (const hand::Joint& joint : hand.skeleton.joints) {
    for (const hand::JointDof& dof : joint.dofs) {
      text +=
          fmt::format("{:<22} {:8.0f} to {:5.0f} {:10.1f}   {}\n", name_of(dof.dof),
                      degrees(dof.lower), degrees(dof.upper), degrees(dof.reference), dof.source);
    }
  }
  return text + "\n" + hand.provenance + "\n";
}

std::string dimensions_csv(const hand::Hand& hand, const hand::HandTape& tape) {
  const hand::HandDimensions& d = hand.dimensions;
  std::string text = "quantity,segment,value_mm\n";
  text += fmt::format(
      "hand_length,,{:.2f}\nhand_circumference,,{:.2f}\nhand_width,,{:.2f}\n"
      "hand_thickness,,{:.2f}\n",
      d.hand_length, d.hand_circumference, d.hand_width, d.hand_thickness);
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const hand::SegmentDimensions& size = d.segment[static_cast<std::size_t>(s)];
    const auto name = name_of(static_cast<hand::Segment>(s));
    text += fmt::format("length,{0},{1:.2f}\nwidth,{0},{2:.2f}\nthickness,{0},{3:.2f}\n", name,
                        size.length, size.width, size.thickness);
  }
  for (const hand::TapeValue& value : hand::values_of(tape)) {
    text += fmt::format("{},{},{:.2f}\n", value.quantity,
                        value.segment ? name_of(*value.segment) : "", value.value);
  }
  return text;
}

std::string placements_text(const grasp::Grasp& grasp) {
  std::string text = status_text(grasp) +
                     fmt::format("{} placements tried; best first:\n", grasp.candidates) +
                     "      grip              score   palm at (mm)                fingers point\n";
  const auto line = [&](std::size_t rank, grasp::Grip grip, double score,
                        const geometry::Rigid3& placed) {
    const Vec3 palm = placed * Vec3(0.0, 70.0, 0.0);
    const Vec3 distal = placed.rotation * Vec3::UnitY();
    text += fmt::format("{:>4}  {:<16} {:6.3f} {:8.1f} {:8.1f} {:8.1f}   {:6.2f} {:5.2f} {:5.2f}\n",
                        rank, name_of(grip), score, palm.x(), palm.y(), palm.z(), distal.x(),
                        distal.y(), distal.z());
  };
  line(1, grasp.grip, grasp.score, grasp.product_from_hand);
  for (std::size_t i = 0; i < grasp.runners_up.size(); ++i) {
    const grasp::GraspRunnerUp& other = grasp.runners_up[i];
    line(i + 2, other.grip, other.score, other.product_from_hand);
  }
  return text;
}

std::string status_text(const grasp::Grasp& grasp) {
  std::string status = report::plain_words(grasp.status);
  status[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(status[0])));
  // "held: held by five fingers" would say it twice.
  return (grasp.message.starts_with(status) ? "" : status + ": ") + grasp.message + "\n";
}

std::string grasp_text(const grasp::Grasp& grasp) {
  std::string text = status_text(grasp);
  if (grasp.hold) text += fmt::format("hold: {}\n", grasp.hold_words);
  if (!grasp.fingertips.empty()) {
    text += fmt::format("grip {}; fingertip           reached (mm)       miss (mm)\n",
                        name_of(grasp.grip));
    for (const grasp::FingertipContact& tip : grasp.fingertips) {
      text += fmt::format("  {:<13} {:8.1f} {:8.1f} {:8.1f} {:9.2f}\n", finger_words(tip.finger),
                          tip.reached.x(), tip.reached.y(), tip.reached.z(), tip.miss);
    }
  }
  text += fmt::format("{:<24} {:<42} {}\n", "part of the hand", "why it closed no further",
                      "pressed in, mm");
  for (const grasp::SegmentStop& stop : grasp.stops) {
    text += fmt::format("{:<24} {:<42} {:14.2f}\n", report::plain_words(stop.segment),
                        report::plain_words(stop.reason), stop.penetration);
  }
  return text + posture_text(grasp.posture);
}

namespace {

/// "2.1 .. 4.2 .. 6.3", a dash for tissue without a solution.
std::string range_text(double low, double nominal, double high, int decimals, bool is_low,
                       bool is_high) {
  return fmt::format("{} .. {:.{}f} .. {}", is_low ? fmt::format("{:.{}f}", low, decimals) : "-",
                     nominal, decimals, is_high ? fmt::format("{:.{}f}", high, decimals) : "-");
}

/// Soft, nominal and stiff tissue, and where the total force comes from.
std::string band_text(const contact::ContactResult& contact) {
  if (!contact.band) return "";
  const contact::ContactBandRow& all = contact.band->total;
  const contact::RegionContact& total = contact.total;
  const bool is_low = all.force_low > 0.0;
  const bool is_high = all.force_high > 0.0;
  std::string text = fmt::format(
      "with soft .. usual .. stiff skin: force {} N, area {} mm²,\n"
      "  peak on a sensor cell {} MPa\n",
      range_text(all.force_low, total.force, all.force_high, 1, is_low, is_high),
      range_text(all.area_low, total.area, all.area_high, 0, is_low, is_high),
      range_text(all.peak_pressure_cells_low, total.peak_pressure_cells,
                 all.peak_pressure_cells_high, 3, is_low, is_high));
  std::vector<contact::ContactBandRow> rows = contact.band->regions;
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return a.force_per_modulus > b.force_per_modulus;
  });
  text += "10 % stiffer skin in one region adds most to the force:\n ";
  for (std::size_t i = 0; i < std::min<std::size_t>(rows.size(), 3); ++i) {
    text += fmt::format("{} {} {:.2f} N", i == 0 ? "" : ",",
                        with_plain_names(std::string(name_of(rows[i].region))),
                        0.1 * rows[i].force_per_modulus);
  }
  return text + "\n";
}

}  // namespace

std::string equations_text(const contact::ContactModel& model) {
  return fmt::format("{} ({} kernel, {}, {} regions)", name_of(model), name_of(model.kernel),
                     name_of(model.tissue), name_of(model.coupling));
}

std::string contact_text(const contact::ContactResult& contact) {
  const std::string equations = "equations: " + equations_text(contact.model) + "\n";
  if (contact.status == contact::ContactStatus::kNoContact) return "no contact\n" + equations;
  const auto row = [](std::string_view name, const contact::RegionContact& r) {
    return fmt::format("{:<35} {:8.2f} {:9.0f} {:10.3f} {:10.3f} {:10.3f}\n", name, r.force, r.area,
                       r.peak_pressure, r.peak_pressure_cells, r.mean_pressure);
  };
  std::string text =
      fmt::format("{:<35} {:>8} {:>9} {:>10} {:>10} {:>10}\n", "region of the skin", "force",
                  "area", "peak", "on a cell", "mean") +
      fmt::format("{:<35} {:>8} {:>9} {:>10} {:>10} {:>10}\n", "", "N", "mm²", "MPa", "MPa", "MPa");
  for (const contact::RegionContact& r : contact.regions)
    text += row(report::plain_words(r.region), r);
  text += row("whole hand", contact.total);
  const Vec3& f = contact.total.force_vector;
  text += fmt::format("sum of the force vectors {:.2f} N (force is the sum of their lengths)\n",
                      f.norm());
  return text + band_text(contact) + equations;
}

}  // namespace palmar::cli
