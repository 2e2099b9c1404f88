// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palmar::grasp {

/// A convex body in D dimensions: sum over groups g of s_g x_g with x_g in the convex hull of the
/// group's points and 0 <= s_g <= 1 (each group on its own), or with sum_g s_g <= 1 (all groups
/// share). The origin always belongs to it.
template <int D>
struct PointGroups {
  using Point = Eigen::Matrix<double, D, 1>;
  std::vector<std::vector<Point>> group;
  bool is_sum = false;  ///< true: Minkowski sum of the groups' hulls; false: hull of their union
};

/// h(u) = max over the body of u . x.
template <int D>
double support(const PointGroups<D>& body, const Eigen::Matrix<double, D, 1>& direction);

struct BodyOptions {
  bool with_volume = true;
  /// Relative gap of the bounds at which the search for the distance, or the volume, ends; 0 runs
  /// until it is exact but for rounding.
  double distance_gap = 0.0, volume_gap = 0.0;
  /// More facets than this are not made, alive or replaced, for the distance and for the volume;
  /// what is known then are bounds.
  int max_facets = 20000, max_volume_facets = 60000;
};

/// How far a convex body reaches around the origin.
template <int D>
struct BodyMeasures {
  int rank = 0;                   ///< of the points; below D the body is flat
  bool contains_origin = false;   ///< strictly inside
  double distance = 0.0;          ///< of the origin from the boundary: the upper bound
  double distance_lower = 0.0;    ///< proven; 0 unless contains_origin
  double volume = 0.0;            ///< of the polytope found: a lower bound
  double volume_upper = 0.0;      ///< proven; infinite where no volume was asked for
  bool is_distance_exact = true;  ///< both bounds agree but for rounding
  bool is_volume_exact = true;
  /// Unit normal of the nearest facet; for a body that doesn't hold the origin inside, a direction
  /// in which it doesn't reach at all (h = 0), for a flat one a direction normal to it.
  Eigen::Matrix<double, D, 1> weakest = Eigen::Matrix<double, D, 1>::Zero();
  int facets = 0;  ///< of the polytope found
};

/// Distance of the origin from the boundary and volume of a convex body in 3 or 6 dimensions, by a
/// polytope inside it that grows: the facet F nearest to the origin (n . x = b) asks for the body's
/// farthest point along n; the facets that see it are replaced (beneath-beyond). Whatever the
/// polytope, min_F b_F <= distance <= min_F h(n_F), and with V_F the volume between F and an inner
/// point c,
///
///     sum V_F <= volume <= sum ((h(n_F) - n_F . c) / (b_F - n_F . c))^D V_F.
///
/// A union of points ends with equality; a sum of many groups has more facets than can be listed
/// and ends with bounds. So that points on a common plane (as those of every cone are) make facets
/// of general position, the polytope's points are moved by 1e-7 of the body's size, in ways drawn
/// from their numbers; the volume is taken at the true places, the distance from the true plane.
/// Source: Barber, Dobkin, Huhdanpaa 1996 (growing hull); van den Bergen 2001 (support functions).
template <int D>
BodyMeasures<D> measure(const PointGroups<D>& body, const BodyOptions& options = {});

extern template double support<3>(const PointGroups<3>&, const Eigen::Matrix<double, 3, 1>&);
extern template double support<6>(const PointGroups<6>&, const Eigen::Matrix<double, 6, 1>&);
extern template BodyMeasures<3> measure<3>(const PointGroups<3>&, const BodyOptions&);
extern template BodyMeasures<6> measure<6>(const PointGroups<6>&, const BodyOptions&);

}  // namespace palmar::grasp
