// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/hold_site.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/grasp/holds/twin_handles.h"

namespace palmar::grasp {
namespace {

// Triangles of one part, with the vertices that they use.
geometry::TriangleMesh mesh_of_part(const geometry::TriangleMesh& mesh,
                                    const std::vector<int>& part_of_triangle, int part) {
  geometry::TriangleMesh result;
  std::vector<int> index(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (part_of_triangle[t] != part) continue;
    Triangle corners = mesh.triangles[t];
    for (int& v : corners) {
      if (index[v] < 0) {
        index[v] = static_cast<int>(result.vertices.size());
        result.vertices.push_back(mesh.vertices[v]);
      }
      v = index[v];
    }
    result.triangles.push_back(corners);
  }
  return result;
}

// Means of the sections about a place on a part, the nearer the more they count.
struct MeanSection {
  double girth = 0.0, width = 0.0, thickness = 0.0;
  Vec3 wide = Vec3::UnitY();
};

MeanSection mean_section(const product::ProductPart& part, double middle, double reach) {
  MeanSection mean;
  if (part.sections.empty()) return {part.girth, part.width, part.thickness, part.line[0].zero};
  const double spacing = 1.0 / static_cast<double>(part.sections.size());
  const double clamped = part.is_ring ? middle - std::floor(middle) : std::clamp(middle, 0.0, 1.0);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double sum = 0.0;
  for (const product::PartSection& section : part.sections) {
    double away = std::abs(section.along - clamped);
    if (part.is_ring) away = std::min(away, 1.0 - away);
    const double weight = 1.0 - away / (reach + 2.0 * spacing);
    if (weight <= 0.0) continue;
    mean.girth += weight * section.girth;
    mean.width += weight * section.width;
    mean.thickness += weight * section.thickness;
    spread += weight * section.wide * section.wide.transpose();  // its sign means nothing
    sum += weight;
  }
  mean.girth /= sum;
  mean.width /= sum;
  mean.thickness /= sum;
  mean.wide = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  return mean;
}

constexpr double kPalmAway = 0.7;  // cosine between the palm and the way out of the other handle

// Extent of a mesh from a point along a direction, mm.
double extent_ahead(const geometry::TriangleMesh& mesh, const Vec3& point, const Vec3& direction) {
  double farthest = 0.0;
  for (const Vec3& v : mesh.vertices) farthest = std::max(farthest, direction.dot(v - point));
  return farthest;
}

// A palm on the outside of one of two handles: the fingers go round both.
void take_both(const product::ProductPart& part, const product::ProductPart& twin, HoldSite& at) {
  GripSite& site = at.site;
  const product::PartPlace beside = product::place_of(twin, site.point);
  const double along = std::clamp(beside.along, 0.0, 1.0);
  Vec3 apart = site.point - product::part_frame(twin, along, 0.0).translation;
  apart -= site.axis * site.axis.dot(apart);
  const double away = apart.norm();
  if (away < 1.0 || apart.dot(at.palm) < kPalmAway * away) return;
  apart /= away;
  at.palm = apart;
  const auto extent = [&](const product::ProductPart& bar) {
    const product::PartSection* nearest = &bar.sections.front();
    for (const product::PartSection& section : bar.sections) {
      if ((section.centre - site.point).norm() < (nearest->centre - site.point).norm()) {
        nearest = &section;
      }
    }
    const double w = apart.dot(nearest->wide), t = std::sqrt(std::max(0.0, 1.0 - w * w));
    return Eigen::Vector2d(std::hypot(w * nearest->width, t * nearest->thickness),
                           std::hypot(t * nearest->width, w * nearest->thickness));
  };
  if (part.sections.empty() || twin.sections.empty()) return;
  const Eigen::Vector2d own = extent(part), others = extent(twin);
  site.point -= 0.5 * (away - 0.5 * own.x() + 0.5 * others.x()) * apart;
  site.wide = apart;
  site.width = away + 0.5 * (own.x() + others.x());
  site.thickness = std::max(own.y(), others.y());
  // A tape round both: two half circles and two straight lines.
  site.girth = std::numbers::pi * site.thickness + 2.0 * std::max(0.0, site.width - site.thickness);
  at.is_round_both = true;
}

}  // namespace

double fingers_breadth(const hand::Hand& hand) { return hand.dimensions.hand_width; }

const product::ProductPart& part_of(const Hold& hold, const product::ProductParts& parts) {
  if (hold.part >= 1 && hold.part <= static_cast<int>(parts.parts.size())) {
    return parts.parts[hold.part - 1];
  }
  std::string list;
  for (const product::ProductPart& part : parts.parts) {
    list += (list.empty() ? "" : ", ") + std::to_string(part.number) + " (" + part.name + ")";
  }
  throw UsageError("part " + std::to_string(hold.part) + " is held, but the product has " +
                   (list.empty() ? "no parts" : "the parts " + list));
}

HoldSite site_of(const Hold& hold, const product::ProductParts& parts,
                 const product::Product& product, const hand::Hand& hand) {
  const product::ProductPart& part = part_of(hold, parts);
  HoldSite result;
  result.is_loop = part.kind == product::PartKind::kLoop;
  GripSite& site = result.site;
  const double breadth = fingers_breadth(hand);
  MeanSection section;
  if (hold.is_over_end) {
    const bool is_far_end = hold.along >= 0.5;
    section = mean_section(part, 0.5, 0.5);
    // As deep below the end as the part is thick, but not beyond its middle.
    const double deep = std::min(0.5, 0.5 * section.width / part.length);
    const geometry::Rigid3 frame =
        product::part_frame(part, is_far_end ? 1.0 - deep : deep, hold.turn);
    site.point = frame.translation;
    site.axis = frame.rotation * Vec3::UnitZ();
    result.palm = (is_far_end ? 1.0 : -1.0) * (frame.rotation * Vec3::UnitX());
    section.wide = frame.rotation * Vec3::UnitY();
    site.length = section.width;
  } else {
    const double middle = hold.along - hold.toward * hold.edge * breadth / part.length;
    const double reach = 0.5 * breadth / part.length;
    const double low = part.is_ring ? middle - reach : std::clamp(middle - reach, 0.0, 1.0);
    const double high = part.is_ring ? middle + reach : std::clamp(middle + reach, 0.0, 1.0);
    const geometry::Rigid3 here = product::part_frame(part, middle, hold.turn);
    section = mean_section(part, middle, reach);
    // Along a curved handle fingers lie as its chord does.
    Vec3 chord = product::part_frame(part, high, 0.0).translation -
                 product::part_frame(part, low, 0.0).translation;
    const Vec3 along_line = here.rotation * Vec3::UnitX();
    if (part.opening && !part.is_ring) {
      // Fingers lie across the opening, whichever way the loop bends there.
      const Vec3 ends = part.line.back().centre - part.line.front().centre;
      chord = part.opening->wide * (part.opening->wide.dot(ends) < 0.0 ? -1.0 : 1.0);
    }
    const bool has_chord = chord.norm() > 1e-6 && chord.dot(along_line) > 0.0;
    site.point = here.translation;
    site.axis = hold.toward * (has_chord ? Vec3(chord.normalized()) : along_line);
    result.palm = here.rotation * Vec3::UnitZ();
    site.length = part.length;
  }
  result.palm = (result.palm - site.axis * site.axis.dot(result.palm)).normalized();
  site.wide = (section.wide - site.axis * site.axis.dot(section.wide)).normalized();
  if (site.wide.dot(result.palm) < 0.0) site.wide = -site.wide;
  site.girth = section.girth;
  site.width = section.width;
  site.thickness = section.thickness;
  if (const product::ProductPart* twin = twin_of(part, parts);
      twin != nullptr && !hold.is_over_end) {
    take_both(part, *twin, result);
  }
  site.ahead = extent_ahead(product.mesh, site.point, site.axis);
  site.score = 1.0;
  const double turn =
      std::atan2(site.axis.dot(site.wide.cross(result.palm)), site.wide.dot(result.palm));
  result.turn = hand.side == hand::Side::kRight ? turn : -turn;
  return result;
}

std::shared_ptr<const geometry::DistanceField> grasped_surface(const Hold& hold,
                                                               const product::ProductParts& parts,
                                                               const product::Product& product) {
  const product::ProductPart& part = part_of(hold, parts);
  if (part.kind != product::PartKind::kLoop || parts.parts.size() < 2) return product.distance;
  return std::make_shared<geometry::MeshDistance>(
      mesh_of_part(product.mesh, parts.part_of_triangle, hold.part - 1));
}

}  // namespace palmar::grasp
