// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "text.h"

#include <fmt/format.h>

#include <numbers>

namespace palmar::cli {

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }
double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

std::string hand_text(const Hand& hand) {
  const HandDimensions& d = hand.dimensions;
  std::string text = fmt::format(
      "{} ({} hand): {} vertices, {} triangles, {} bones\n"
      "  hand length L         {:7.1f} mm\n"
      "  hand circumference C  {:7.1f} mm\n"
      "  hand width W          {:7.1f} mm\n"
      "  hand thickness T      {:7.1f} mm\n\n"
      "segment            length  width  thickness  (mm)\n",
      hand.name, name_of(hand.side), hand.skin.vertex_count(), hand.skin.triangle_count(),
      hand.bones.size(), d.hand_length, d.hand_circumference, d.hand_width, d.hand_thickness);
  for (int s = 0; s < kSegmentCount; ++s) {
    const SegmentDimensions& size = d.segment[static_cast<std::size_t>(s)];
    text += fmt::format("{:<17} {:7.1f} {:6.1f} {:10.1f}\n", name_of(static_cast<Segment>(s)),
                        size.length, size.width, size.thickness);
  }
  text += "\ndegree of freedom         range of motion   reference  (deg)\n";
  for (const Joint& joint : hand.skeleton.joints) {
    for (const JointDof& dof : joint.dofs) {
      text +=
          fmt::format("{:<22} {:8.0f} to {:5.0f} {:10.1f}   {}\n", name_of(dof.dof),
                      degrees(dof.lower), degrees(dof.upper), degrees(dof.reference), dof.source);
    }
  }
  return text + "\n" + hand.provenance + "\n";
}

std::string dimensions_csv(const Hand& hand) {
  const HandDimensions& d = hand.dimensions;
  std::string text = "quantity,segment,value_mm\n";
  text += fmt::format(
      "hand_length,,{:.2f}\nhand_circumference,,{:.2f}\nhand_width,,{:.2f}\n"
      "hand_thickness,,{:.2f}\n",
      d.hand_length, d.hand_circumference, d.hand_width, d.hand_thickness);
  for (int s = 0; s < kSegmentCount; ++s) {
    const SegmentDimensions& size = d.segment[static_cast<std::size_t>(s)];
    const auto name = name_of(static_cast<Segment>(s));
    text += fmt::format("length,{0},{1:.2f}\nwidth,{0},{2:.2f}\nthickness,{0},{3:.2f}\n", name,
                        size.length, size.width, size.thickness);
  }
  return text;
}

std::string grasp_text(const Grasp& grasp) {
  std::string text = fmt::format("{}: {}\n", name_of(grasp.status), grasp.message);
  text += "segment           stopped by        penetration (mm)\n";
  for (const SegmentStop& stop : grasp.stops) {
    text += fmt::format("{:<17} {:<17} {:8.2f}\n", name_of(stop.segment), name_of(stop.reason),
                        stop.penetration);
  }
  text += "angles (deg):";
  for (int d = 0; d < kDofCount; ++d) {
    text += fmt::format("{}{} {:.0f}", d % 4 == 0 ? "\n  " : ", ", name_of(static_cast<Dof>(d)),
                        degrees(grasp.posture.angle[static_cast<std::size_t>(d)]));
  }
  return text + "\n";
}

std::string contact_text(const ContactResult& contact) {
  if (contact.status == ContactStatus::kNoContact) return "no contact\n";
  const auto row = [](std::string_view name, const RegionContact& r) {
    return fmt::format("{:<16} {:8.2f} {:9.0f} {:10.3f} {:10.3f} {:10.3f}\n", name, r.force, r.area,
                       r.peak_pressure, r.peak_pressure_cells, r.mean_pressure);
  };
  std::string text =
      "region            force     area       peak  peak cells       mean\n"
      "                      N      mm2        MPa        MPa        MPa\n";
  for (const RegionContact& r : contact.regions) text += row(name_of(r.region), r);
  text += row("all", contact.total);
  const Vec3& f = contact.total.force_vector;
  text += fmt::format("sum of the force vectors {:.2f} N (force is the sum of their lengths)\n",
                      f.norm());
  return text;
}

}  // namespace palmar::cli
