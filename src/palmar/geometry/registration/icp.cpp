// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/registration/icp.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/statistics/median.h"

namespace palmar::geometry {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr double kAgreement = 0.5;  // cosine of 60 degrees between partners' normals

struct Sample {
  Vec3 point, normal;
};

/// Points spread evenly over the area: equal steps along the triangles' areas added up, and within
/// each triangle the additive recurrence of Roberts (2018), folded into it.
std::vector<Sample> spread_samples(const TriangleMesh& mesh, int count) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  const double step = surface_area(mesh) / count;
  std::vector<Sample> samples;
  samples.reserve(count);
  double before = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const std::array<Vec3, 3> corner = {mesh.vertices[t[0]], mesh.vertices[t[1]],
                                        mesh.vertices[t[2]]};
    const double area = triangle_area(corner[0], corner[1], corner[2]);
    while (static_cast<int>(samples.size()) < count &&
           (static_cast<double>(samples.size()) + 0.5) * step < before + area) {
      const auto n = static_cast<double>(samples.size()) + 1.0;
      double u = std::fmod(0.7548776662466927 * n, 1.0), v = std::fmod(0.5698402909980532 * n, 1.0);
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const double w = 1.0 - u - v;
      const Vec3 normal = u * normals[t[0]] + v * normals[t[1]] + w * normals[t[2]];
      samples.push_back({u * corner[0] + v * corner[1] + w * corner[2], normal.normalized()});
    }
    before += area;
  }
  return samples;
}

/// The surface that the other one is placed on.
class FixedSurface {
 public:
  explicit FixedSurface(const TriangleMesh& mesh)
      : mesh_(mesh),
        query_(mesh),
        face_normal_(triangle_normals(mesh)),
        vertex_normal_(vertex_normals(mesh)) {
    const MeshTopology topology = build_topology(mesh);
    is_rim_.resize(mesh.triangles.size(), {false, false, false});
    for (std::size_t h = 0; h < topology.edge_of.size(); ++h) {
      const int edge = topology.edge_of[h];
      // Edge k of a triangle runs from corner k to the next: its points have no weight at k + 2.
      if (edge >= 0 && topology.edge_use[edge] == 1) is_rim_[h / 3][(h % 3 + 2) % 3] = true;
    }
  }

  ClosestPoint closest(const Vec3& point, int hint) const {
    return *query_.closest(point, std::numeric_limits<double>::infinity(),
                           hint >= 0 ? std::optional<int>(hint) : std::nullopt);
  }
  bool is_on_rim(const ClosestPoint& found) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (found.weights[k] == 0.0 && is_rim_[found.triangle][k]) return true;
    }
    return false;
  }
  const Vec3& face_normal(const ClosestPoint& found) const { return face_normal_[found.triangle]; }
  Vec3 smooth_normal(const ClosestPoint& found) const {
    const Triangle& t = mesh_.triangles[found.triangle];
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) normal += found.weights[k] * vertex_normal_[t[k]];
    return normal.normalized();
  }

 private:
  const TriangleMesh& mesh_;
  ClosestPointQuery query_;
  std::vector<Vec3> face_normal_, vertex_normal_;
  std::vector<std::array<bool, 3>> is_rim_;
};

struct Pair {
  ClosestPoint found;
  bool counts = false;  ///< normals agree, and not on a rim
};

/// A place of the moving surface, and the pairs that it makes.
struct Place {
  Rigid3 fixed_from_moving;
  std::vector<Pair> pairs;
  double scale = 0.0;  ///< root mean square distance of the pairs kept, mm
  double reach = 0.0;  ///< largest of them, mm
  int iterations = 0;
  bool has_converged = false;
};

class Registration {
 public:
  Registration(const FixedSurface& fixed, std::vector<Sample> samples, const IcpOptions& options)
      : fixed_(fixed), samples_(std::move(samples)), options_(options) {
    for (const Sample& s : samples_) centre_ += s.point / static_cast<double>(samples_.size());
    for (const Sample& s : samples_) radius_ += (s.point - centre_).squaredNorm();
    radius_ = std::sqrt(radius_ / static_cast<double>(samples_.size()));
  }

  const std::vector<Sample>& samples() const { return samples_; }
  const Vec3& centre() const { return centre_; }
  double radius() const { return radius_; }

  /// Looks for partners and trims; at last (`keeps_near`), only what lies beyond 3.5 standard
  /// deviations, by the median, is left out: trimming good pairs costs accuracy.
  void pair_up(Place& place, bool keeps_near = false) const {
    place.pairs.resize(samples_.size());
    std::vector<double> distances;
    distances.reserve(samples_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      Pair& pair = place.pairs[i];
      const Vec3 point = place.fixed_from_moving * samples_[i].point;
      pair.found = fixed_.closest(point, pair.found.triangle);
      const Vec3 normal = place.fixed_from_moving.rotation * samples_[i].normal;
      pair.counts = fixed_.smooth_normal(pair.found).dot(normal) >= kAgreement &&
                    !fixed_.is_on_rim(pair.found);
      if (pair.counts) distances.push_back(pair.found.distance);
    }
    place.scale = 0.0;
    place.reach = -1.0;
    if (distances.empty()) return;
    std::sort(distances.begin(), distances.end());
    const auto count = static_cast<double>(distances.size());
    const auto kept = static_cast<std::size_t>(std::ceil((1.0 - options_.trim) * count));
    place.reach = distances[std::max<std::size_t>(kept, 1) - 1];
    constexpr double kMedianOfNormal = 0.6745;  // of |z|, z standard normal
    if (keeps_near) {
      place.reach = 3.5 / kMedianOfNormal * distances[distances.size() / 2] + 1e-9 * radius_;
    }
    const auto end = std::upper_bound(distances.begin(), distances.end(), place.reach);
    for (auto d = distances.begin(); d != end; ++d) place.scale += *d * *d;
    place.scale = std::sqrt(place.scale / static_cast<double>(end - distances.begin()));
  }

  /// Normal equations of the motion (turn about the centre in units of 1 / radius, shift) for the
  /// pairs that count: A of the smoothed normals without weights if `is_plain`.
  void accumulate(const Place& place, bool is_plain, Mat6& A, Vec6& b) const {
    A.setZero();
    b.setZero();
    const Vec3 middle = place.fixed_from_moving * centre_;
    const double soft = 3.0 * std::max(place.scale, 1e-12 * radius_);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Pair& pair = place.pairs[i];
      if (!pair.counts || pair.found.distance > place.reach) continue;
      const Vec3 point = place.fixed_from_moving * samples_[i].point;
      Vec3 n = fixed_.smooth_normal(pair.found);
      if (!is_plain) n = (n + place.fixed_from_moving.rotation * samples_[i].normal).normalized();
      Vec6 row;
      row << (point - middle).cross(n) / radius_, n;
      const double r = n.dot(pair.found.point - point);
      const double ratio = pair.found.distance / soft;
      const double weight = is_plain ? 1.0 : std::pow(1.0 + ratio * ratio, -2);
      A.noalias() += weight * row * row.transpose();
      b += weight * r * row;
    }
  }

  /// One step; how far it moves the samples at most, mm.
  double step(Place& place) const {
    Mat6 A;
    Vec6 b;
    accumulate(place, false, A, b);
    // Held a little where the shape doesn't hold it, so that it doesn't wander along itself.
    A += 1e-7 * A.trace() * Mat6::Identity();
    Vec6 x = A.ldlt().solve(b);
    if (!x.allFinite()) return 0.0;
    constexpr double kLargestTurn = 0.35;  // rad; the planes hold for small turns only
    x *= std::min(1.0, kLargestTurn * radius_ / std::max(x.head<3>().norm(), 1e-300));
    const Vec3 turn = x.head<3>() / radius_;
    const double angle = turn.norm();
    const Quat q = angle > 0.0 ? Quat(Eigen::AngleAxisd(angle, turn / angle)) : Quat::Identity();
    const Vec3 middle = place.fixed_from_moving * centre_;
    place.fixed_from_moving =
        Rigid3{q, middle - q * middle + x.tail<3>()} * place.fixed_from_moving;
    return 2.0 * radius_ * angle + x.tail<3>().norm();
  }

  void search(Place& place, int iterations, bool keeps_near = false) const {
    place.has_converged = false;
    pair_up(place, keeps_near);
    for (int k = 0; k < iterations && place.reach >= 0.0; ++k) {
      const double moved = step(place);
      pair_up(place, keeps_near);
      ++place.iterations;
      if (moved < options_.tolerance) {
        place.has_converged = true;
        return;
      }
    }
  }

  /// Distances of all samples; those without a fit partner count as `missing` at least.
  std::vector<double> distances(const Place& place, double missing) const {
    std::vector<double> d;
    d.reserve(samples_.size());
    for (const Pair& pair : place.pairs) {
      d.push_back(pair.counts ? pair.found.distance : std::max(missing, pair.found.distance));
    }
    return d;
  }

 private:
  const FixedSurface& fixed_;
  std::vector<Sample> samples_;
  const IcpOptions& options_;
  Vec3 centre_ = Vec3::Zero();
  double radius_ = 0.0;
};

/// Orders places by what their distances cost, a far one no more than a little: c is three times
/// the least median of all.
void sort_places(const Registration& registration, std::vector<Place>& places) {
  const double missing = 0.5 * registration.radius();
  double least = std::numeric_limits<double>::infinity();
  for (const Place& place : places) {
    least = std::min(least, statistics::median(registration.distances(place, missing)));
  }
  const double c = std::max(3.0 * least, 0.01 * registration.radius());
  std::vector<std::pair<double, std::size_t>> cost;
  for (std::size_t k = 0; k < places.size(); ++k) {
    double sum = 0.0;
    for (const double d : registration.distances(places[k], missing)) {
      sum += std::min(d, c) * std::min(d, c);
    }
    cost.emplace_back(sum, k);
  }
  std::sort(cost.begin(), cost.end());
  std::vector<Place> sorted;
  sorted.reserve(places.size());
  for (const auto& [sum, k] : cost) sorted.push_back(std::move(places[k]));
  places = std::move(sorted);
}

/// Leaves only the first of several places that have become the same.
void drop_repeated(const Registration& registration, std::vector<Place>& places) {
  std::vector<Place> kept;
  for (Place& place : places) {
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const Place& other) {
      const Vec3 shift = place.fixed_from_moving * registration.centre() -
                         other.fixed_from_moving * registration.centre();
      const double turn =
          place.fixed_from_moving.rotation.angularDistance(other.fixed_from_moving.rotation);
      return shift.norm() / registration.radius() + turn < 0.05;
    });
    if (is_new) kept.push_back(std::move(place));
  }
  places = std::move(kept);
}

/// Turns by `angle` about the principal axes of the samples and about the diagonals between them.
std::vector<Quat> start_turns(const Registration& registration, double angle) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Sample& s : registration.samples()) {
    const Vec3 d = s.point - registration.centre();
    spread += d * d.transpose();
  }
  const Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  std::vector<Quat> turns = {Quat::Identity()};
  if (angle <= 0.0) return turns;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      for (int k = -1; k <= 1; ++k) {
        const int ends = std::abs(i) + std::abs(j) + std::abs(k);
        if (ends != 1 && ends != 3) continue;
        const Vec3 axis = axes * Vec3(i, j, k).normalized();
        turns.emplace_back(Eigen::AngleAxisd(angle, axis));
        // Wide searches need a ring in between.
        if (angle > 1.3) turns.emplace_back(Eigen::AngleAxisd(0.5 * angle, axis));
      }
    }
  }
  return turns;
}

std::vector<Place> start_places(const Registration& registration, const Rigid3& start,
                                const Vec3& fixed_centre, double angle) {
  std::vector<Place> places;
  const Vec3 middle = start * registration.centre();
  std::vector<Vec3> shifts = {Vec3::Zero()};
  if (angle > 0.0 && (fixed_centre - middle).norm() > 0.15 * registration.radius()) {
    shifts.push_back(fixed_centre - middle);
  }
  for (const Vec3& shift : shifts) {
    for (const Quat& q : start_turns(registration, angle)) {
      Place place;
      const Quat turn = start.rotation * q * start.rotation.conjugate();
      place.fixed_from_moving = Rigid3{turn, middle + shift - turn * middle} * start;
      places.push_back(std::move(place));
    }
  }
  return places;
}

Vec3 centre_of(const std::vector<Sample>& samples) {
  Vec3 sum = Vec3::Zero();
  for (const Sample& s : samples) sum += s.point;
  return sum / static_cast<double>(samples.size());
}

void require_area(const TriangleMesh& mesh, const char* which) {
  if (surface_area(mesh) > 0.0) return;
  throw InputError("registration: the " + std::string(which) + " surface has no area (" +
                   std::to_string(mesh.triangle_count()) + " triangles); a surface is required");
}

}  // namespace

void IcpOptions::check() const {
  if (!(trim >= 0.0 && trim <= 0.9)) {
    throw UsageError("registration: trim is " + std::to_string(trim) + "; 0 to 0.9 is allowed");
  }
  if (max_iterations < 1) {
    throw UsageError("registration: at most " + std::to_string(max_iterations) +
                     " iterations; 1 or more are required");
  }
  if (!(tolerance > 0.0)) {
    throw UsageError("registration: the tolerance is " + std::to_string(tolerance) +
                     " mm; more than 0 is required");
  }
  if (samples < 12) {
    throw UsageError("registration: " + std::to_string(samples) +
                     " samples; 12 or more are required");
  }
  if (!(start_turn >= 0.0 && start_turn <= std::numbers::pi)) {
    throw UsageError("registration: starts turned by " + std::to_string(start_turn) +
                     " rad; 0 to pi is allowed");
  }
}

IcpResult register_rigidly(const TriangleMesh& moving, const TriangleMesh& fixed,
                           const Rigid3& start, const IcpOptions& options,
                           const Progress& progress) {
  options.check();
  require_area(moving, "moving");
  require_area(fixed, "fixed");
  const FixedSurface surface(fixed);
  constexpr int kCoarseSamples = 200, kRivalSteps = 10;
  const Registration coarse(
      surface, spread_samples(moving, std::min(kCoarseSamples, options.samples)), options);
  const Registration fine(surface, spread_samples(moving, options.samples), options);

  // A few steps show the hopeless starts; more of them the rivals, which all samples decide.
  std::vector<Place> places = start_places(
      coarse, start, centre_of(spread_samples(fixed, kCoarseSamples)), options.start_turn);
  for (const auto& [iterations, survivors] :
       {std::pair<int, std::size_t>{6, 8}, std::pair<int, std::size_t>{15, 3}}) {
    if (places.size() == 1) break;
    for (Place& place : places) {
      progress.throw_if_cancelled();
      coarse.search(place, iterations);
    }
    sort_places(coarse, places);
    places.resize(std::min(places.size(), survivors));
  }
  drop_repeated(coarse, places);
  for (Place& place : places) {
    progress.throw_if_cancelled();
    place.pairs.clear();
    fine.search(place, kRivalSteps);
  }
  sort_places(fine, places);
  Place& best = places.front();
  fine.search(best, options.max_iterations);
  fine.search(best, options.max_iterations, true);

  IcpResult result;
  result.fixed_from_moving = best.fixed_from_moving;
  result.iterations = best.iterations;
  result.trimmed_rms = best.scale;
  int near = 0;
  for (const Pair& pair : best.pairs) {
    result.mean += pair.found.distance / static_cast<double>(best.pairs.size());
    // Rounding: an exact fit has a root mean square of 0.
    if (pair.counts && pair.found.distance <= 3.0 * best.scale + 1e-9 * fine.radius()) ++near;
  }
  if (best.reach < 0.0) return result;  // no partners
  result.overlap = static_cast<double>(near) / static_cast<double>(best.pairs.size());
  result.has_converged = best.has_converged;
  Mat6 A;
  Vec6 b;
  fine.accumulate(best, true, A, b);
  const Vec6 eigenvalues = Eigen::SelfAdjointEigenSolver<Mat6>(A).eigenvalues();
  if (eigenvalues[5] > 0.0) result.conditioning = std::max(0.0, eigenvalues[0] / eigenvalues[5]);
  return result;
}

}  // namespace palmar::geometry
