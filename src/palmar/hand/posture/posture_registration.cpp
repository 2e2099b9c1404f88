// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/posture/posture_registration.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::hand::registration {
namespace {

constexpr double kNormalsAgree = 0.2;  // cosine; 78 degrees: fingers lie side by side
constexpr double kSkinStep = 1e-4;     // rad; of the numeric Jacobian
constexpr double kPriorSd = 2.0;       // rad; decides only what the mesh doesn't
constexpr double kOneOf = 25.0;        // so many neighbouring points show as much as one
constexpr double kLargestSd = 0.35;    // rad; as in PostureFitOptions

/// Robust squared distance: grows no more than to c^2.
double bounded(double squared, double c) { return squared / (1.0 + squared / (c * c)); }

/// Its weight in least squares.
double weight_of(double distance, double c) {
  const double q = 1.0 + distance * distance / (c * c);
  return 1.0 / (q * q);
}

/// Middle, axes (columns, largest extent first, right-handed) and reach along the first.
struct Frame {
  Vec3 middle = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double low = 0.0, high = 0.0;  ///< along the first axis, from the middle
};

Frame frame_of(const std::vector<Vec3>& points) {
  Frame frame;
  for (const Vec3& p : points) frame.middle += p;
  frame.middle /= static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) spread += (p - frame.middle) * (p - frame.middle).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
  frame.axes.col(0) = eigen.eigenvectors().col(2);
  frame.axes.col(1) = eigen.eigenvectors().col(1);
  frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
  for (const Vec3& p : points) {
    const double along = frame.axes.col(0).dot(p - frame.middle);
    frame.low = std::min(frame.low, along);
    frame.high = std::max(frame.high, along);
  }
  return frame;
}

}  // namespace

Target::Target(const geometry::TriangleMesh& mesh)
    : mesh_(mesh),
      normal_(geometry::area_weighted_normals(mesh.vertices, mesh.triangles)),
      query_(mesh) {
  std::map<std::pair<int, int>, int> count;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      ++count[{std::min(a, b), std::max(a, b)}];
    }
  }
  is_border_.assign(3 * mesh.triangles.size(), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      is_border_[3 * i + k] = count[{std::min(a, b), std::max(a, b)}] == 1;
    }
  }
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    area += (b - a).cross(c - a).norm();
  }
  if (!(area > 0.0)) throw InputError("the mesh of the hand has no area");
  const Frame frame = frame_of(mesh.vertices);
  extent_ = frame.high - frame.low;
}

std::optional<Partner> Target::partner(const Vec3& point, const Vec3& normal, double reach) const {
  const auto near = query_.closest(point, reach);
  if (!near) return std::nullopt;
  const int t = near->triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    // On an open edge: the nearest surface may lie beyond it.
    if (is_border_[3 * t + k] && near->weights[(k + 2) % 3] < 1e-9) return std::nullopt;
  }
  Vec3 n = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    n += near->weights[k] * normal_[mesh_.triangles[t][k]];
  }
  n.stableNormalize();
  if (n.dot(normal) < kNormalsAgree) return std::nullopt;
  return Partner{near->point, n, near->distance};
}

std::vector<Partner> Target::samples(int count) const {
  std::vector<double> until;
  double area = 0.0;
  for (const Triangle& t : mesh_.triangles) {
    const Vec3& a = mesh_.vertices[t[0]];
    const Vec3& b = mesh_.vertices[t[1]];
    const Vec3& c = mesh_.vertices[t[2]];
    area += 0.5 * (b - a).cross(c - a).norm();
    until.push_back(area);
  }
  std::vector<Partner> samples;
  std::size_t i = 0;
  for (int k = 0; k < count; ++k) {
    const double wanted = area * (k + 0.5) / count;
    while (i + 1 < until.size() && until[i] < wanted) ++i;
    const Triangle& t = mesh_.triangles[i];
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
    for (const int v : t) {
      point += mesh_.vertices[v] / 3.0;
      normal += normal_[v];
    }
    samples.push_back({point, normal.stableNormalized(), 0.0});
  }
  return samples;
}

namespace {

std::vector<int> every(const Hand& hand, int stride) {
  std::vector<int> vertices;
  for (int v = 0; v < hand.skin.vertex_count(); v += stride) vertices.push_back(v);
  return vertices;
}

std::vector<HandPoint> points_at(const Hand& hand, const std::vector<int>& vertices) {
  std::vector<HandPoint> points;
  for (const int v : vertices) {
    points.push_back({hand.skin.vertices[v], v, {}});
  }
  return points;
}

}  // namespace

SkinPoints::SkinPoints(const Hand& hand, int stride)
    : hand_(&hand), vertex_(every(hand, stride)), points_(hand, points_at(hand, vertex_)) {
  std::vector<double> area(hand.skin.vertices.size(), 0.0);
  for (const Triangle& t : hand.skin.triangles) {
    const Vec3& a = hand.skin.vertices[t[0]];
    const Vec3& b = hand.skin.vertices[t[1]];
    const Vec3& c = hand.skin.vertices[t[2]];
    const double third = (b - a).cross(c - a).norm() / 6.0;
    for (const int v : t) area[v] += third;
  }
  const std::vector<Vec3> normal =
      geometry::area_weighted_normals(hand.skin.vertices, hand.skin.triangles);
  const double wrist = hand.skeleton.joint(JointId::kWrist).centre.y();
  for (const int vertex : vertex_) {
    const bool is_proximal = hand.skin.vertices[vertex].y() < wrist;
    constexpr double kFacesBack = -0.7;  // cosine to distal
    is_forearm_.push_back(is_proximal);
    is_cut_.push_back(is_proximal && normal[vertex].y() < kFacesBack);
    area_.push_back(area[vertex]);
  }
}

PosedSkin SkinPoints::pose(const Pose& pose) const {
  const std::vector<Vec3> skin = pose_skin(*hand_, pose.posture);
  const std::vector<Vec3> normal = geometry::area_weighted_normals(skin, hand_->skin.triangles);
  PosedSkin posed;
  posed.point.reserve(vertex_.size());
  posed.normal.reserve(vertex_.size());
  for (const int vertex : vertex_) {
    posed.point.push_back(pose * skin[vertex]);
    posed.normal.push_back(pose.mesh_from_hand.rotation * normal[vertex]);
  }
  return posed;
}

namespace {

/// A pair of a skin point and the tangent plane that it is drawn to.
struct Pair {
  std::size_t skin = 0;  ///< of SkinPoints
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
  double weight = 0.0;
};

/// One resolution of the search.
class Stage {
 public:
  Stage(const Hand& hand, const Target& target, int stride, int samples, bool fits_scale)
      : hand_(&hand),
        target_(&target),
        skin_(hand, stride),
        sample_(target.samples(samples)),
        fits_scale_(fits_scale) {}

  /// Robust squared distance both ways, mm^2.
  double cost(const Pose& pose, double c) const {
    const PosedSkin posed = skin_.pose(pose);
    double there = 0.0, count = 0.0;
    for (std::size_t i = 0; i < posed.point.size(); ++i) {
      if (skin_.is_forearm(i)) continue;
      const auto partner = target_->partner(posed.point[i], posed.normal[i], 3.0 * c);
      there += partner ? bounded(partner->distance * partner->distance, c) : c * c;
      count += 1.0;
    }
    double back = 0.0;
    for (const Partner& sample : sample_) {
      const auto nearest = nearest_skin(posed, sample, 3.0 * c);
      back += nearest ? bounded(nearest->second, c) : c * c;
    }
    return there / count + back / static_cast<double>(sample_.size());
  }

  /// One round: partners, then the least squares of the linearised distances within the ranges.
  /// Says how far the farthest point moved, mm.
  double round(Pose& pose, double c, Registration& result) const {
    const std::vector<Pair> pairs = pairs_at(pose, c);
    const int first = fits_scale_ ? 7 : 6;
    const Eigen::Index n = first + kDofCount;
    const Eigen::MatrixXd rows = linearised(pose, pairs, n);
    // The triangular factor holds all that the many rows say: 30 rows go on.
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
    const auto size = std::min(rows.rows(), n + 1);
    const Eigen::MatrixXd small =
        qr.matrixQR().topRows(size).template triangularView<Eigen::Upper>();
    const Eigen::MatrixXd factor = small.leftCols(n);
    const Eigen::VectorXd right = small.col(n);

    geometry::LeastSquaresProblem problem;
    problem.evaluate = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
      r = factor * x - right;
      if (j != nullptr) *j = factor;
    };
    constexpr double kTurn = 0.2, kShift = 30.0, kBend = 0.3, kGrowth = 0.05;  // of one round
    problem.lower = Eigen::VectorXd::Constant(n, -kTurn);
    problem.upper = Eigen::VectorXd::Constant(n, kTurn);
    problem.lower.segment<3>(3).setConstant(-kShift);
    problem.upper.segment<3>(3).setConstant(kShift);
    if (fits_scale_) {
      problem.lower[6] = std::max(-kGrowth, std::log(0.6 / pose.scale) - 1e-9);
      problem.upper[6] = std::min(kGrowth, std::log(1.7 / pose.scale) + 1e-9);
    }
    for (int d = 0; d < kDofCount; ++d) {
      const JointDof& dof = hand_->skeleton.dof(static_cast<Dof>(d));
      const double angle = pose.posture[dof.dof];
      problem.lower[first + d] = std::max(-kBend, dof.lower - angle) - 1e-12;
      problem.upper[first + d] = std::min(kBend, dof.upper - angle) + 1e-12;
    }
    const geometry::LeastSquaresSolution found = geometry::solve_least_squares(
        problem, Eigen::VectorXd::Zero(n),
        {.max_iterations = 50, .gradient_tolerance = 1e-6, .step_tolerance = 1e-7});

    const Eigen::VectorXd& x = found.x;
    pose = moved(pose, x);
    ++result.iterations;
    result.at_limit.clear();
    result.not_observed.clear();
    const Eigen::MatrixXd covariance =
        (factor.transpose() * factor).ldlt().solve(Eigen::MatrixXd::Identity(n, n));
    for (int d = 0; d < kDofCount; ++d) {
      const JointDof& dof = hand_->skeleton.dof(static_cast<Dof>(d));
      if (std::sqrt(std::max(0.0, covariance(first + d, first + d))) > kLargestSd) {
        result.not_observed.push_back(dof.dof);
      }
      if (found.at_bound[first + d] && (pose.posture[dof.dof] <= dof.lower + 1e-9 ||
                                        pose.posture[dof.dof] >= dof.upper - 1e-9)) {
        result.at_limit.push_back(dof.dof);
      }
    }
    constexpr double kArm = 100.0;  // mm per rad, from the hand's middle
    return std::max({kArm * x.head<3>().norm(), x.segment<3>(3).norm(),
                     0.5 * kArm * x.tail(kDofCount).cwiseAbs().maxCoeff()});
  }

 private:
  /// Index and squared distance of the nearest skin point whose normal agrees.
  std::optional<std::pair<std::size_t, double>> nearest_skin(const PosedSkin& posed,
                                                             const Partner& sample,
                                                             double reach) const {
    double least = reach * reach;
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < posed.point.size(); ++i) {
      const double squared = (posed.point[i] - sample.point).squaredNorm();
      if (squared >= least || posed.normal[i].dot(sample.normal) < kNormalsAgree) continue;
      least = squared;
      nearest = i;
    }
    if (!nearest) return std::nullopt;
    return std::make_pair(*nearest, least);
  }

  std::vector<Pair> pairs_at(const Pose& pose, double c) const {
    const PosedSkin posed = skin_.pose(pose);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < posed.point.size(); ++i) {
      if (skin_.is_cut(i)) continue;
      const auto partner = target_->partner(posed.point[i], posed.normal[i], 3.0 * c);
      if (!partner) continue;
      pairs.push_back({i, partner->point, partner->normal, weight_of(partner->distance, c)});
    }
    // As much weight back as there, however many there are of each.
    const double share = static_cast<double>(skin_.count()) / static_cast<double>(sample_.size());
    for (const Partner& sample : sample_) {
      const auto nearest = nearest_skin(posed, sample, 3.0 * c);
      if (!nearest || skin_.is_cut(nearest->first)) continue;
      pairs.push_back({nearest->first, sample.point, sample.normal,
                       share * weight_of(std::sqrt(nearest->second), c)});
    }
    return pairs;
  }

  /// The pose after a small step of the unknowns: turn and shift about the mesh's frame at the
  /// hand's middle, growth, angles.
  Pose moved(const Pose& pose, const Eigen::VectorXd& x) const {
    const int first = fits_scale_ ? 7 : 6;
    Pose result = pose;
    const Vec3 pivot = pose * kMiddle;
    const Vec3 turn = x.head<3>();
    const double angle = turn.norm();
    const Quat q = angle > 0 ? Quat(Eigen::AngleAxisd(angle, turn / angle)) : Quat::Identity();
    if (fits_scale_) result.scale *= std::exp(x[6]);
    result.mesh_from_hand.rotation = (q * pose.mesh_from_hand.rotation).normalized();
    result.mesh_from_hand.translation =
        pivot + x.segment<3>(3) - result.mesh_from_hand.rotation * (result.scale * kMiddle);
    for (int d = 0; d < kDofCount; ++d) {
      const JointDof& dof = hand_->skeleton.dof(static_cast<Dof>(d));
      result.posture[dof.dof] =
          std::clamp(pose.posture[dof.dof] + x[first + d], dof.lower, dof.upper);
    }
    return result;
  }

  /// Rows (J | -r) of all pairs and of the prior.
  Eigen::MatrixXd linearised(const Pose& pose, const std::vector<Pair>& pairs,
                             Eigen::Index n) const {
    const int first = fits_scale_ ? 7 : 6;
    const PosablePoints& points = skin_.points();
    const std::vector<Vec3> at = points.pose(pose.posture);
    const auto m = static_cast<Eigen::Index>(pairs.size());
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(m + n, n + 1);
    const Vec3 pivot = pose * kMiddle;
    std::vector<double> root(pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Pair& pair = pairs[k];
      root[k] = std::sqrt(pair.weight / kOneOf);
      const Vec3 p = pose * at[pair.skin];
      const auto row = static_cast<Eigen::Index>(k);
      rows.row(row).segment<3>(0) = root[k] * (p - pivot).cross(pair.normal).transpose();
      rows.row(row).segment<3>(3) = root[k] * pair.normal.transpose();
      if (fits_scale_) rows(row, 6) = root[k] * pair.normal.dot(p - pivot);
      rows(row, n) = root[k] * pair.normal.dot(pair.point - p);
    }
    for (int d = 0; d < kDofCount; ++d) {
      const auto dof = static_cast<Dof>(d);
      Posture ahead = pose.posture;
      // Away from the nearer end of the range: skinning may have a kink at the reference angle.
      ahead[dof] += kSkinStep;
      const std::vector<Vec3> there = points.pose(ahead);
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        const Vec3 velocity = pose.mesh_from_hand.rotation *
                              (pose.scale / kSkinStep * (there[pairs[k].skin] - at[pairs[k].skin]));
        rows(static_cast<Eigen::Index>(k), first + d) = root[k] * pairs[k].normal.dot(velocity);
      }
    }
    const Posture reference = reference_posture(hand_->skeleton);
    for (Eigen::Index j = 0; j < n; ++j) {
      const bool is_angle = j >= first;
      const auto dof = static_cast<Dof>(is_angle ? j - first : 0);
      const double sd = is_angle ? kPriorSd : j >= 3 && j < 6 ? 1e3 : 10.0;
      rows(m + j, j) = 1.0 / sd;
      if (is_angle) rows(m + j, n) = (reference[dof] - pose.posture[dof]) / sd;
    }
    return rows;
  }

  inline static const Vec3 kMiddle = Vec3(0.0, 80.0, 0.0);  // hand frame, mm

  const Hand* hand_;
  const Target* target_;
  SkinPoints skin_;
  std::vector<Partner> sample_;
  bool fits_scale_;
};

struct Start {
  Pose pose;
  double cost = 0.0;
};

/// Named postures along the mesh's principal axes, both ways round, by the middle and by either
/// end.
std::vector<Pose> starts_for(const Hand& hand, const Target& target, bool fits_scale) {
  std::vector<Vec3> cloud;
  for (const Partner& sample : target.samples(2000)) cloud.push_back(sample.point);
  const Frame whole = frame_of(cloud);
  std::vector<Posture> postures = {reference_posture(hand.skeleton)};
  for (const std::string& name : posture_names()) {
    postures.push_back(*named_posture(hand.skeleton, name));
  }
  std::vector<Pose> starts;
  const SkinPoints skin(hand, 5);
  for (const Posture& posture : postures) {
    const std::vector<Vec3> points = skin.points().pose(posture);
    const Frame model = frame_of(points);
    // The fingers' end of the model's long axis is the one that looks distal.
    const double distal = model.axes.col(0).y() >= 0 ? 1.0 : -1.0;
    const double to_end = distal > 0 ? model.high : -model.low;
    const double length = model.high - model.low;
    for (const double end : {1.0, -1.0}) {
      // An arm hides the hand's own axes: those of the part near this end as long as the hand.
      std::vector<Vec3> part;
      const double tip = end > 0 ? whole.high : whole.low;
      for (const Vec3& p : cloud) {
        const double along = whole.axes.col(0).dot(p - whole.middle);
        if (std::abs(tip - along) <= 1.05 * length) part.push_back(p);
      }
      if (part.size() < 10) continue;
      const Frame near = frame_of(part);
      Vec3 long_axis = near.axes.col(0);
      if (long_axis.dot(end * whole.axes.col(0)) < 0) long_axis = -long_axis;
      double reach = 0.0;
      for (const Vec3& p : part) reach = std::max(reach, long_axis.dot(p - near.middle));
      Eigen::Matrix3d model_axes;
      model_axes.col(0) = distal * model.axes.col(0);
      model_axes.col(1) = model.axes.col(1);
      model_axes.col(2) = model_axes.col(0).cross(model_axes.col(1));
      for (const double side : {1.0, -1.0}) {
        Eigen::Matrix3d mesh_axes;
        mesh_axes.col(0) = long_axis;
        mesh_axes.col(1) = side * near.axes.col(1);
        mesh_axes.col(2) = mesh_axes.col(0).cross(mesh_axes.col(1));
        const Quat turn(Eigen::Matrix3d(mesh_axes * model_axes.transpose()));
        for (const bool by_middle : {true, false}) {
          Pose pose;
          pose.posture = posture;
          pose.mesh_from_hand.rotation = turn.normalized();
          // One overall size: by the breadth of what is near, which a forearm changes least.
          (void)fits_scale;
          Vec3 shift = near.middle - pose.mesh_from_hand.rotation * model.middle;
          if (!by_middle) shift += (reach - to_end) * long_axis;
          pose.mesh_from_hand.translation = shift;
          starts.push_back(pose);
        }
      }
    }
  }
  return starts;
}

void run_rounds(const Stage& stage, Pose& pose, const std::vector<double>& widths,
                Registration& result, const Progress& progress) {
  for (const double c : widths) {
    progress.throw_if_cancelled();
    stage.round(pose, c, result);
  }
}

/// Looks at every finger bent otherwise, keeps what lowers the cost.
bool try_other_fingers(const Hand& hand, const Stage& stage, Pose& pose, double c) {
  struct Bend {
    double mcp, pip, dip;  // deg
  };
  constexpr std::array<Bend, 7> kBends = {{{0, 5, 0},
                                           {25, 25, 12},
                                           {50, 50, 30},
                                           {80, 85, 60},
                                           {10, 80, 55},
                                           {70, 10, 5},
                                           {30, 65, 40}}};
  double least = stage.cost(pose, c);
  bool is_better = false;
  const auto consider = [&](const Posture& asked) {
    Pose other = pose;
    other.posture = clamp_to_range(hand.skeleton, asked).posture;
    const double cost = stage.cost(other, c);
    if (cost >= 0.98 * least) return;
    least = cost;
    pose = other;
    is_better = true;
  };
  for (int f = 1; f < kFingerCount; ++f) {
    const int first = static_cast<int>(Dof::kIndexMcpFlexion) + 4 * (f - 1);
    for (const Bend& bend : kBends) {
      Posture posture = pose.posture;
      posture[static_cast<Dof>(first)] = bend.mcp * geometry::kDegree;
      posture[static_cast<Dof>(first + 2)] = bend.pip * geometry::kDegree;
      posture[static_cast<Dof>(first + 3)] = bend.dip * geometry::kDegree;
      consider(posture);
    }
  }
  for (const std::string& name : posture_names()) {
    const Posture named = *named_posture(hand.skeleton, name);
    Posture posture = pose.posture;
    for (const Dof dof : {Dof::kThumbCmcFlexion, Dof::kThumbCmcAbduction, Dof::kThumbMpFlexion,
                          Dof::kThumbIpFlexion}) {
      posture[dof] = named[dof];
    }
    consider(posture);
  }
  return is_better;
}

}  // namespace

Registration run(const Hand& hand, const Target& target, bool fits_scale, int max_iterations,
                 const Progress& progress) {
  const Stage glance(hand, target, 24, 150, false);
  const Stage coarse(hand, target, 12, 300, fits_scale);
  const Stage fine(hand, target, 4, 900, fits_scale);
  Registration result;

  std::vector<Start> starts;
  for (const Pose& pose : starts_for(hand, target, fits_scale)) {
    progress.throw_if_cancelled();
    starts.push_back({pose, glance.cost(pose, 20.0)});
  }
  const auto by_cost = [](const Start& a, const Start& b) { return a.cost < b.cost; };
  std::stable_sort(starts.begin(), starts.end(), by_cost);
  constexpr std::size_t kFollowed = 10;
  if (starts.size() > kFollowed) starts.resize(kFollowed);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    progress.update(0.1 + 0.5 * static_cast<double>(i) / static_cast<double>(starts.size()),
                    "trying placements of the hand");
    run_rounds(coarse, starts[i].pose, {20, 20, 20, 15, 15, 15, 12, 12, 10, 10}, result, progress);
    starts[i].cost = coarse.cost(starts[i].pose, 10.0);
  }
  std::stable_sort(starts.begin(), starts.end(), by_cost);
  constexpr std::size_t kFinalists = 3;
  if (starts.size() > kFinalists) starts.resize(kFinalists);
  for (Start& start : starts) {
    for (int again = 0; again < 3; ++again) {
      const Pose before = start.pose;
      if (!try_other_fingers(hand, coarse, start.pose, 10.0)) break;
      Start other = start;
      run_rounds(coarse, other.pose, {12, 12, 10, 10, 8, 8, 8}, result, progress);
      other.cost = coarse.cost(other.pose, 10.0);
      if (other.cost >= start.cost) {
        start.pose = before;
        break;
      }
      start = other;
    }
  }
  std::stable_sort(starts.begin(), starts.end(), by_cost);

  Pose pose = starts.front().pose;
  double c = 8.0;
  constexpr double kNarrowest = 3.0;  // mm; about the noise of scans and another person's shape
  constexpr double kStill = 0.02;     // mm
  for (int i = 0; i < max_iterations; ++i) {
    progress.update(0.6 + 0.4 * i / max_iterations, "registering the hand to the mesh");
    const double motion = fine.round(pose, c, result);
    if (c == kNarrowest && motion < kStill) break;
    c = std::max(kNarrowest, 0.85 * c);
  }
  result.pose = pose;
  result.cost = fine.cost(pose, 10.0);
  return result;
}

}  // namespace palmar::hand::registration
