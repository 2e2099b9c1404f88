// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/grip_choice.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "palmar/grasp/power/section_stack.h"

namespace palmar::grasp {
namespace {

constexpr double kSmallShare = 0.14;   // of hand length
constexpr double kEvenExtents = 1.33;  // largest over smallest extent of a ball
constexpr double kLeastFill = 0.42, kMostFill = 0.63;
constexpr double kSectionSpacing = 3.0;  // mm

}  // namespace

BodyShape body_shape(const geometry::TriangleMesh& mesh) {
  BodyShape shape;
  const PrincipalFrame frame = principal_frame(mesh);
  shape.centre = frame.centre;
  shape.axes = frame.axes;
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.extend(frame.axes.transpose() * (v - frame.centre));
  if (box.isEmpty()) return shape;
  shape.extent = box.diagonal();
  double volume = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - frame.centre;
    const Vec3 b = mesh.vertices[t[1]] - frame.centre;
    const Vec3 c = mesh.vertices[t[2]] - frame.centre;
    volume += a.dot(b.cross(c)) / 6.0;
  }
  const double whole = shape.extent.prod();
  shape.fill = whole > 0.0 ? volume / whole : 0.0;
  return shape;
}

bool is_ball_like(const BodyShape& shape) {
  return shape.extent.minCoeff() > 0.0 &&
         shape.extent.maxCoeff() < kEvenExtents * shape.extent.minCoeff() &&
         shape.fill > kLeastFill && shape.fill < kMostFill;
}

Grip wrap_for(double girth, double hand_length) {
  const double share = girth / std::numbers::pi / hand_length;
  if (share < kSmallShare) return Grip::kSmallDiameter;
  return share > kLargestClosed ? Grip::kLargeDiameter : Grip::kMediumWrap;
}

std::vector<GripSite> ball_sites(const geometry::TriangleMesh& mesh, const BodyShape& shape) {
  std::vector<GripSite> sites;
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = shape.axes.col(k);
    const double station = axis.dot(shape.centre);
    const SectionOutline* nearest = nullptr;
    double gap = std::numeric_limits<double>::infinity();
    const std::vector<Section> sections = sections_along(mesh, axis, kSectionSpacing);
    for (const Section& section : sections) {
      for (const SectionOutline& outline : section.outlines) {
        const double away = std::abs(section.station - station) +
                            (nearest && outline.girth < nearest->girth ? 1e-6 : 0.0);
        if (away >= gap) continue;
        gap = away;
        nearest = &outline;
      }
    }
    if (nearest == nullptr) continue;
    GripSite site;
    site.point = nearest->centroid;
    site.axis = axis;
    site.wide = nearest->wide;
    site.girth = nearest->girth;
    site.thickness = nearest->thickness;
    site.width = nearest->width;
    site.length = shape.extent[k];
    site.ahead = 0.5 * shape.extent[k];
    site.score = 1.0;
    sites.push_back(site);
  }
  return sites;
}

}  // namespace palmar::grasp
