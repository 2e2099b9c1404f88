// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/hand_motion.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "hands/capture/picture_vectors.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat63 = Eigen::Matrix<double, 6, 3>;
using Vec6 = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t kFewestTracks = 60;

struct Observation {
  int picture = 0;
  Vec2 pixel;
};
struct Track {
  std::vector<Observation> seen;
  Vec3 point = Vec3::Zero();
};

Eigen::Matrix3d cross_of(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Distance of a pixel of the second picture from the epipolar line of one of the first.
class Epipolar {
 public:
  Epipolar(const PhotoCamera& a, const PhotoCamera& b) : a_(a), b_(b) {
    const geometry::Rigid3 move = b.camera_from_world * a.camera_from_world.inverse();
    essential_ = cross_of(move.translation) * move.rotation.toRotationMatrix();
  }
  double distance(const Vec2& first, const Vec2& second) const {
    const Vec3 x = a_.lens.direction_of(first).homogeneous();
    const Vec3 y = b_.lens.direction_of(second).homogeneous();
    const Vec3 line = essential_ * x;
    return std::abs(y.dot(line)) / std::max(1e-12, line.head<2>().norm()) * b_.lens.focal_x;
  }

 private:
  const PhotoCamera& a_;
  const PhotoCamera& b_;
  Eigen::Matrix3d essential_;
};

class Problem {
 public:
  Problem(const std::vector<PhotoCamera>& cameras, const std::vector<int>& position, int positions)
      : motions(positions), cameras_(cameras), position_(position) {}

  std::vector<Track> tracks;
  std::vector<geometry::Rigid3> motions;  ///< board_from_hand

  /// Point in the camera's frame.
  Vec3 local(const Observation& o, const Vec3& point) const {
    const int p = o.picture;
    return cameras_[p].camera_from_world * (motions[position_[p]] * point);
  }
  Vec2 residual(const Observation& o, const Vec3& point) const {
    const Vec3 x = local(o, point);
    if (x.z() < 1.0) return Vec2::Constant(1e3);
    return cameras_[o.picture].lens.pixel_of(x.head<2>() / x.z()) - o.pixel;
  }

  /// The point nearest to its rays, then a few steps of Gauss and Newton.
  void locate(Track& track) const {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Vec3 b = Vec3::Zero();
    for (const Observation& o : track.seen) {
      const int p = o.picture;
      const geometry::Rigid3 hand_from_board = motions[position_[p]].inverse();
      const Vec3 centre = hand_from_board * cameras_[p].centre();
      const Vec3 ray = hand_from_board.rotation * cameras_[p].ray(o.pixel);
      const Eigen::Matrix3d m = Eigen::Matrix3d::Identity() - ray * ray.transpose();
      a += m;
      b += m * centre;
    }
    track.point = a.ldlt().solve(b);
  }

  /// Residuals of all observations, ascending.
  std::vector<double> residuals() const {
    std::vector<double> all;
    for (const Track& track : tracks) {
      for (const Observation& o : track.seen) all.push_back(residual(o, track.point).norm());
    }
    std::sort(all.begin(), all.end());
    return all;
  }

  /// Observations farther off than `limit` leave; tracks with fewer than two positions or pictures,
  /// too.
  void prune(double limit) {
    std::vector<Track> kept;
    for (Track& track : tracks) {
      std::vector<Observation> near;
      for (const Observation& o : track.seen) {
        if (residual(o, track.point).norm() <= limit) near.push_back(o);
      }
      if (near.size() < 2) continue;
      track.seen = std::move(near);
      kept.push_back(std::move(track));
    }
    tracks = std::move(kept);
  }

  /// One damped step of all motions and points; false if it lowers nothing. A loop of its own, not
  /// solve_least_squares(): points are eliminated one by one (Schur complement), which leaves six
  /// unknowns a motion of thousands in all.
  bool step(double scale, const HandMotionOptions& options, bool moves, double& damping) {
    const std::size_t free = moves ? motions.size() - 1 : 0;
    const auto size = static_cast<long>(6 * free);
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(size);
    Vec6 prior;
    prior << Vec3::Constant(1.0 / std::pow(options.turn_prior * geometry::kDegree, 2)),
        Vec3::Constant(1.0 / std::pow(options.shift_prior, 2));
    for (std::size_t p = 0; p < free; ++p) {
      const auto at = static_cast<long>(6 * p);
      a.diagonal().segment<6>(at) += prior;
      g.segment<6>(at) += prior.cwiseProduct(motion_of(motions[p + 1]));
    }
    struct Reduced {
      Eigen::Matrix3d inverse;
      Vec3 gradient;
      std::vector<std::pair<int, Mat63>> mixed;
    };
    std::vector<Reduced> reduced(tracks.size());
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      Eigen::Matrix3d c = Eigen::Matrix3d::Zero();
      Reduced& own = reduced[t];
      own.gradient.setZero();
      for (const Observation& o : tracks[t].seen) {
        const int p = o.picture;
        const auto place = static_cast<std::size_t>(position_[p]);
        const PhotoCamera& camera = cameras_[p];
        const Vec3 moved = motions[place] * tracks[t].point;
        const Vec3 x = camera.camera_from_world * moved;
        if (x.z() < 1.0) continue;
        const Vec2 r = residual(o, tracks[t].point);
        const double weight = 1.0 / (1.0 + r.squaredNorm() / (scale * scale));
        Eigen::Matrix<double, 2, 3> by_local;
        by_local << camera.lens.focal_x / x.z(), 0, -camera.lens.focal_x * x.x() / (x.z() * x.z()),
            0, camera.lens.focal_y / x.z(), -camera.lens.focal_y * x.y() / (x.z() * x.z());
        const Eigen::Matrix<double, 2, 3> by_board =
            by_local * camera.camera_from_world.rotation.toRotationMatrix();
        const Eigen::Matrix<double, 2, 3> by_point =
            by_board * motions[place].rotation.toRotationMatrix();
        c += weight * by_point.transpose() * by_point;
        own.gradient += weight * by_point.transpose() * r;
        if (!moves || place == 0) continue;
        Eigen::Matrix<double, 2, 6> by_motion;
        by_motion << -by_board * cross_of(moved - motions[place].translation), by_board;
        const auto at = static_cast<long>(6 * (place - 1));
        a.block<6, 6>(at, at) += weight * by_motion.transpose() * by_motion;
        g.segment<6>(at) += weight * by_motion.transpose() * r;
        own.mixed.emplace_back(static_cast<int>(at), weight * by_motion.transpose() * by_point);
      }
      c.diagonal() *= 1.0 + damping;
      c.diagonal().array() += 1e-9;
      own.inverse = c.inverse();
      for (const auto& [i, m] : own.mixed) {
        g.segment<6>(i) -= m * own.inverse * own.gradient;
        for (const auto& [j, n] : own.mixed) {
          a.block<6, 6>(i, j) -= m * own.inverse * n.transpose();
        }
      }
    }
    if (size > 0) a.diagonal() *= 1.0 + damping;
    const Eigen::VectorXd change = size > 0 ? Eigen::VectorXd(-a.ldlt().solve(g)) : g;
    const double before = cost(scale, options);
    const auto old_motions = motions;
    std::vector<Vec3> old_points;
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      old_points.push_back(tracks[t].point);
      Vec3 gradient = reduced[t].gradient;
      for (const auto& [i, m] : reduced[t].mixed) gradient += m.transpose() * change.segment<6>(i);
      tracks[t].point -= reduced[t].inverse * gradient;
    }
    for (std::size_t p = 0; p < free; ++p) {
      const Vec6 d = change.segment<6>(static_cast<long>(6 * p));
      const Vec3 turn = d.head<3>();
      if (turn.norm() > 0.0) {
        motions[p + 1].rotation =
            (Quat(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * motions[p + 1].rotation)
                .normalized();
      }
      motions[p + 1].translation += d.tail<3>();
    }
    if (cost(scale, options) < before) {
      damping = std::max(1e-9, 0.3 * damping);
      return true;
    }
    motions = old_motions;
    for (std::size_t t = 0; t < tracks.size(); ++t) tracks[t].point = old_points[t];
    damping *= 10.0;
    return false;
  }

  void settle(double scale, const HandMotionOptions& options, bool moves) {
    double damping = 1e-3;
    constexpr int kRounds = 25;
    int failures = 0;
    for (int round = 0; round < kRounds && failures < 4; ++round) {
      failures = step(scale, options, moves, damping) ? 0 : failures + 1;
    }
  }

 private:
  static Vec6 motion_of(const geometry::Rigid3& motion) {
    const Eigen::AngleAxisd turn(motion.rotation);
    Vec6 v;
    v << turn.angle() * turn.axis(), motion.translation;
    return v;
  }

  double cost(double scale, const HandMotionOptions& options) const {
    double sum = 0.0;
    for (const Track& track : tracks) {
      for (const Observation& o : track.seen) {
        sum += scale * scale * std::log1p(residual(o, track.point).squaredNorm() / (scale * scale));
      }
    }
    for (const geometry::Rigid3& motion : motions) {
      const Vec6 v = motion_of(motion);
      sum += v.head<3>().squaredNorm() / std::pow(options.turn_prior * geometry::kDegree, 2) +
             v.tail<3>().squaredNorm() / std::pow(options.shift_prior, 2);
    }
    return sum;
  }

  const std::vector<PhotoCamera>& cameras_;
  const std::vector<int>& position_;
};

/// Points joined by matches near their epipolar lines; those that would show one picture two points
/// are none.
std::vector<Track> tracks_of(const std::vector<PhotoCamera>& cameras, const PointMatches& matches,
                             double gate) {
  std::vector<std::size_t> begin(matches.point.size() + 1, 0);
  for (std::size_t p = 0; p < matches.point.size(); ++p) {
    begin[p + 1] = begin[p] + matches.point[p].size();
  }
  std::vector<std::size_t> parent(begin.back());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&parent](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto pixel = [&matches](std::size_t picture, std::size_t i) {
    const auto& p = matches.point[picture][i];
    return Vec2(p[0], p[1]);
  };
  for (std::size_t n = 0; n < matches.pair.size(); ++n) {
    const auto a = static_cast<std::size_t>(matches.pair[n][0]);
    const auto b = static_cast<std::size_t>(matches.pair[n][1]);
    const Epipolar epipolar(cameras[a], cameras[b]);
    for (const auto& [first, second] : matches.match[n]) {
      const auto i = static_cast<std::size_t>(first), j = static_cast<std::size_t>(second);
      if (epipolar.distance(pixel(a, i), pixel(b, j)) > gate) continue;
      const std::size_t x = root(begin[a] + i), y = root(begin[b] + j);
      parent[std::max(x, y)] = std::min(x, y);
    }
  }
  std::vector<std::vector<Observation>> by_root(begin.back());
  for (std::size_t p = 0; p < matches.point.size(); ++p) {
    for (std::size_t i = 0; i < matches.point[p].size(); ++i) {
      by_root[root(begin[p] + i)].push_back({static_cast<int>(p), pixel(p, i)});
    }
  }
  std::vector<Track> tracks;
  for (auto& seen : by_root) {
    if (seen.size() < 2) continue;
    bool is_twice = false;  // pictures ascend
    for (std::size_t k = 1; k < seen.size(); ++k) {
      is_twice = is_twice || seen[k].picture == seen[k - 1].picture;
    }
    if (!is_twice) tracks.push_back({std::move(seen), Vec3::Zero()});
  }
  return tracks;
}

}  // namespace

void HandMotionOptions::check() const {
  const auto require = [](bool holds, const char* field, double value, const char* allowed) {
    if (!holds)
      throw UsageError(fmt::format("motion {}: {:g}; {} is allowed", field, value, allowed));
  };
  require(gate > 0 && gate <= 100, "gate", gate, "0 to 100 pixels");
  require(shift_prior > 0 && shift_prior <= 100, "shift_prior", shift_prior, "0 to 100 mm");
  require(turn_prior > 0 && turn_prior <= 45, "turn_prior", turn_prior, "0 to 45 deg");
  require(worth > 0 && worth <= 1, "worth", worth, "0 to 1");
}

HandMotion fit_hand_motion(const std::vector<PhotoCamera>& cameras,
                           const std::vector<int>& position, const PointMatches& matches,
                           const HandMotionOptions& options) {
  options.check();
  if (cameras.size() != position.size() || cameras.size() != matches.point.size()) {
    throw UsageError("one camera, one position and one list of points per picture are required");
  }
  const int positions =
      position.empty() ? 0 : *std::max_element(position.begin(), position.end()) + 1;
  HandMotion motion;
  motion.board_from_hand.resize(positions);
  if (positions < 2) return motion;

  Problem problem(cameras, position, positions);
  problem.tracks = tracks_of(cameras, matches, options.gate);
  for (Track& track : problem.tracks) problem.locate(track);
  problem.prune(options.gate);
  constexpr double kScale = 0.5;  // pixels; what a point of the skin is good for
  for (const double limit : {4.0, 2.0, 1.0}) {
    problem.settle(kScale, options, true);
    problem.prune(limit);
  }
  problem.settle(kScale, options, true);
  motion.tracks = static_cast<int>(problem.tracks.size());
  motion.after = statistics::median(problem.residuals());
  if (problem.tracks.size() < kFewestTracks) return motion;

  Problem still = problem;
  std::fill(still.motions.begin(), still.motions.end(), geometry::Rigid3{});
  still.settle(kScale, options, false);
  motion.before = statistics::median(still.residuals());
  motion.is_applied = motion.after <= options.worth * motion.before;
  if (!motion.is_applied) return motion;
  motion.board_from_hand = problem.motions;
  Vec3 middle = Vec3::Zero();
  for (const Track& track : problem.tracks) middle += track.point;
  middle /= static_cast<double>(problem.tracks.size());
  for (const geometry::Rigid3& one : problem.motions) {
    motion.largest_shift = std::max(motion.largest_shift, (one * middle - middle).norm());
    motion.largest_turn =
        std::max(motion.largest_turn, std::abs(Eigen::AngleAxisd(one.rotation).angle()));
  }
  return motion;
}

}  // namespace palmar::capture
