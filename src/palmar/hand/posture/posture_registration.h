// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/skin/hand_points.h"

// Parts of fit_posture_to_mesh(), see posture_from_mesh.h.
namespace palmar::hand::registration {

/// Where a hand is in the mesh's frame and how it is posed: p -> R (s p) + t.
struct Pose {
  Posture posture;
  geometry::Rigid3 mesh_from_hand;
  double scale = 1.0;
  Vec3 operator*(const Vec3& in_hand) const { return mesh_from_hand * (scale * in_hand); }
};

/// A point of the mesh that a point of the skin is drawn to.
struct Partner {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  double distance = 0.0;  ///< mm
};

/// The mesh of a posed hand, ready to be asked.
class Target {
 public:
  /// Throws InputError for a mesh without area.
  explicit Target(const geometry::TriangleMesh& mesh);

  /// Nearest point of the mesh within `reach` [mm] if its normal agrees with `normal` and it isn't
  /// on an open border.
  std::optional<Partner> partner(const Vec3& point, const Vec3& normal, double reach) const;

  /// Points spread evenly over the mesh's area, with their normals, always the same ones.
  std::vector<Partner> samples(int count) const;

  double extent() const { return extent_; }  ///< longest side of the box along the principal axes

 private:
  geometry::TriangleMesh mesh_;
  std::vector<Vec3> normal_;     ///< per vertex, area-weighted
  std::vector<char> is_border_;  ///< per triangle and edge
  geometry::ClosestPointQuery query_;
  double extent_ = 0.0;
};

/// Some of a posed skin.
struct PosedSkin {
  std::vector<Vec3> point, normal;  ///< mesh's frame
};

/// Every `stride`-th vertex of a hand's skin, with normals.
class SkinPoints {
 public:
  SkinPoints(const Hand& hand, int stride);

  std::size_t count() const { return vertex_.size(); }
  const PosablePoints& points() const { return points_; }
  /// Skin of the forearm's stub, which a mesh may not have.
  bool is_forearm(std::size_t i) const { return is_forearm_[i] != 0; }
  /// Of these: the cut through the forearm, which no mesh has.
  bool is_cut(std::size_t i) const { return is_cut_[i] != 0; }
  double area(std::size_t i) const { return area_[i]; }  ///< of the reference posture, mm^2

  PosedSkin pose(const Pose& pose) const;

 private:
  const Hand* hand_;
  std::vector<int> vertex_;
  std::vector<char> is_forearm_, is_cut_;
  std::vector<double> area_;
  PosablePoints points_;
};

struct Registration {
  Pose pose;
  double cost = 0.0;  ///< of the robust distances both ways, mm^2
  std::vector<Dof> not_observed, at_limit;
  int iterations = 0;
};

/// The whole search, from the starts to the last stage.
Registration run(const Hand& hand, const Target& target, bool fits_scale, int max_iterations,
                 const Progress& progress);

}  // namespace palmar::hand::registration
