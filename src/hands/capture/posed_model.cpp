// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/posed_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/numeric_jacobian.h"
#include "palmar/hand/instance/segment_scaling.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::capture {
namespace {

/// Joint centres from the MCP joint on (thumb: CMC, MP, IP) and the fingertip.
struct Chain {
  std::vector<Vec3> node;
  std::vector<hand::Segment> segment;  ///< that the link after a node belongs to; thumb: first the
                                       ///< palm
};

Chain chain_of(const hand::Skeleton& skeleton, hand::Finger finger) {
  Chain chain;
  if (finger == hand::Finger::kThumb) {
    chain.node.push_back(skeleton.joint(hand::JointId::kThumbCmc).centre);
    chain.segment.push_back(hand::Segment::kPalm);
  }
  for (const auto& segment : hand::segments_of(finger)) {
    if (!segment) continue;
    chain.node.push_back(skeleton.joint(hand::joint_of(*segment)).centre);
    chain.segment.push_back(*segment);
  }
  chain.node.push_back(skeleton.fingertips[index_of(finger)]);
  return chain;
}

const hand::JointDof& flexion_of(const hand::Skeleton& skeleton, hand::Segment phalanx) {
  return skeleton.joint(hand::joint_of(phalanx)).dofs.back();
}

hand::SegmentScales scales_to(const hand::SegmentScaling& scaling, const hand::Skeleton& from,
                              const hand::Skeleton& to) {
  constexpr double kLeast = 0.5, kMost = 2.0;
  const auto ratio = [&](double a, double b) {
    return b > 1e-6 ? std::clamp(a / b, kLeast, kMost) : 1.0;
  };
  const auto spread = [](const hand::Skeleton& s) {
    return (s.joint(hand::JointId::kIndexMcp).centre - s.joint(hand::JointId::kLittleMcp).centre)
        .norm();
  };
  const auto height = [](const hand::Skeleton& s) {
    return (s.joint(hand::JointId::kMiddleMcp).centre - s.joint(hand::JointId::kWrist).centre)
        .norm();
  };
  hand::SegmentScales scales;
  auto& palm = scales.segment[index_of(hand::Segment::kPalm)];
  palm.along = ratio(height(to), height(from));
  palm.across = ratio(spread(to), spread(from));
  palm.thickness = palm.across;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const Chain mine = chain_of(from, finger), wanted = chain_of(to, finger);
    const std::size_t first = finger == hand::Finger::kThumb ? 1 : 0;
    const auto& parts = scaling.parts(finger);
    for (std::size_t k = first; k + 1 < mine.node.size(); ++k) {
      const double has = (mine.node[k + 1] - mine.node[k]).norm();
      const double needs = (wanted.node[k + 1] - wanted.node[k]).norm();
      // Up to the base crease the first link is stretched as the palm is.
      double of_palm = 0.0;
      if (k == first) {
        of_palm = has;
        for (const auto& segment : parts) of_palm -= segment[0];
        of_palm = std::max(0.0, of_palm);
      }
      auto& factors = scales.segment[index_of(mine.segment[k])];
      factors.along = ratio(needs - palm.along * of_palm, has - of_palm);
      factors.across = factors.thickness = palm.across;
    }
  }
  return scales;
}

/// Where the chain's nodes are in a posture, in the hand frame.
Vec3 posed_node(const hand::PosedSkeleton& posed, const Chain& chain, hand::Finger finger,
                std::size_t k) {
  if (k == 0) return chain.node[0];
  if (finger == hand::Finger::kThumb && k == 1) return posed.thumb_metacarpal * chain.node[1];
  return posed.segment[index_of(chain.segment[k - 1])] * chain.node[k];
}

class PostureProblem {
 public:
  PostureProblem(const hand::Skeleton& mine, const hand::Skeleton& wanted)
      : mine_(mine), wanted_(wanted) {
    for (int f = 0; f < hand::kFingerCount; ++f) {
      const auto finger = static_cast<hand::Finger>(f);
      chain_.push_back(chain_of(mine, finger));
      target_.push_back(chain_of(wanted, finger));
    }
    for (int d = 3; d < hand::kDofCount; ++d) free_.push_back(static_cast<hand::Dof>(d));
    start_ = hand::reference_posture(mine);
  }

  void solve(PosedModel& model) const {
    const auto n = static_cast<Eigen::Index>(free_.size() + 6);
    geometry::LeastSquaresProblem problem;
    problem.lower.resize(n);
    problem.upper.resize(n);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    constexpr double kBeyond = 0.35;  // rad; people differ in their ranges
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const hand::JointDof& dof = mine_.dof(free_[k]);
      const auto i = static_cast<Eigen::Index>(k);
      problem.lower[i] = dof.lower - kBeyond;
      problem.upper[i] = dof.upper + kBeyond;
      x[i] = dof.reference;
    }
    problem.lower.tail<6>() << -1, -1, -1, -60, -60, -60;
    problem.upper.tail<6>() << 1, 1, 1, 60, 60, 60;
    problem.evaluate = geometry::with_numeric_jacobian(
        [&](const Eigen::VectorXd& at, Eigen::VectorXd& r) { r = residual(at); });
    const geometry::LeastSquaresSolution found =
        geometry::solve_least_squares(problem, x, {.max_iterations = 100});
    model.posture = posture(found.x);
    model.scan_from_hand = place(found.x);
    const hand::PosedSkeleton posed = hand::pose_skeleton(mine_, model.posture);
    double sum = 0.0;
    int count = 0;
    for (int f = 0; f < hand::kFingerCount; ++f) {
      for (std::size_t k = 0; k < chain_[f].node.size(); ++k) {
        const Vec3 p =
            model.scan_from_hand * posed_node(posed, chain_[f], static_cast<hand::Finger>(f), k);
        sum += (p - target_[f].node[k]).norm();
        ++count;
      }
    }
    model.joint_miss = sum / count;
  }

 private:
  hand::Posture posture(const Eigen::VectorXd& x) const {
    hand::Posture p = start_;
    for (std::size_t k = 0; k < free_.size(); ++k) p[free_[k]] = x[static_cast<Eigen::Index>(k)];
    return p;
  }
  static geometry::Rigid3 place(const Eigen::VectorXd& x) {
    const Vec3 turn = x.tail<6>().head<3>();
    const double angle = turn.norm();
    geometry::Rigid3 result;
    if (angle > 1e-12) result.rotation = Quat(Eigen::AngleAxisd(angle, turn / angle));
    result.translation = x.tail<3>();
    return result;
  }
  Eigen::VectorXd residual(const Eigen::VectorXd& x) const {
    constexpr double kAxis = 8.0;   // mm per unit: half a finger's breadth
    constexpr double kPrior = 0.3;  // mm per rad
    const hand::Posture p = posture(x);
    const geometry::Rigid3 scan_from_hand = place(x);
    const hand::PosedSkeleton posed = hand::pose_skeleton(mine_, p);
    std::vector<double> r;
    const auto add = [&](const Vec3& v) { r.insert(r.end(), v.begin(), v.end()); };
    for (int f = 0; f < hand::kFingerCount; ++f) {
      const auto finger = static_cast<hand::Finger>(f);
      const Chain& chain = chain_[f];
      for (std::size_t k = 0; k < chain.node.size(); ++k) {
        add(scan_from_hand * posed_node(posed, chain, finger, k) - target_[f].node[k]);
        // Flexion axes as the phalanx after the joint carries them. Those of the MCP joints stay
        // with the palm.
        if (k == 0 || k >= chain.segment.size()) continue;
        const Quat turn =
            scan_from_hand.rotation * posed.segment[index_of(chain.segment[k])].rotation;
        add(kAxis * (turn * flexion_of(mine_, chain.segment[k]).axis -
                     flexion_of(wanted_, chain.segment[k]).axis));
      }
    }
    for (const hand::Dof d : free_) r.push_back(kPrior * (p[d] - start_[d]));
    return Eigen::Map<const Eigen::VectorXd>(r.data(), static_cast<Eigen::Index>(r.size()));
  }

  const hand::Skeleton& mine_;
  const hand::Skeleton& wanted_;
  std::vector<Chain> chain_, target_;
  std::vector<hand::Dof> free_;
  hand::Posture start_;
};

/// What the joints miss, spread smoothly over space.
class Remainder {
 public:
  Remainder(const PosedModel& model, const hand::Skeleton& skeleton) {
    const hand::PosedSkeleton posed = hand::pose_skeleton(model.sized.skeleton, model.posture);
    const auto add = [&](const Vec3& in_hand, const Vec3& wanted) {
      node_.push_back(model.scan_from_hand * in_hand);
      miss_.push_back(wanted - node_.back());
    };
    for (int f = 0; f < hand::kFingerCount; ++f) {
      const auto finger = static_cast<hand::Finger>(f);
      const Chain chain = chain_of(model.sized.skeleton, finger);
      const Chain wanted = chain_of(skeleton, finger);
      for (std::size_t k = 0; k < chain.node.size(); ++k) {
        add(posed_node(posed, chain, finger, k), wanted.node[k]);
      }
    }
    add(model.sized.skeleton.joint(hand::JointId::kWrist).centre,
        skeleton.joint(hand::JointId::kWrist).centre);
  }
  Vec3 at_point(const Vec3& p) const {
    constexpr double kNear = 64.0;  // mm^2
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (std::size_t k = 0; k < node_.size(); ++k) {
      const double q = (p - node_[k]).squaredNorm() + kNear;
      sum += miss_[k] / (q * q);
      weights += 1.0 / (q * q);
    }
    return sum / weights;
  }

 private:
  std::vector<Vec3> node_, miss_;
};

}  // namespace

PosedModel posed_model(const hand::Hand& model, const hand::Skeleton& skeleton) {
  PosedModel result;
  const hand::SegmentScaling scaling(model);
  result.sized = scaling.hand(scales_to(scaling, model.skeleton, skeleton));
  PostureProblem(result.sized.skeleton, skeleton).solve(result);
  return result;
}

std::vector<Vec3> skin_at(const PosedModel& model, const hand::Skeleton& skeleton) {
  const Remainder remainder(model, skeleton);
  std::vector<Vec3> skin = hand::pose_skin(model.sized, model.posture);
  for (Vec3& v : skin) {
    v = model.scan_from_hand * v;
    v += remainder.at_point(v);
  }
  return skin;
}

std::vector<geometry::TriangleMesh> bones_at(const PosedModel& model,
                                             const hand::Skeleton& skeleton) {
  const Remainder remainder(model, skeleton);
  std::vector<geometry::TriangleMesh> bones = hand::pose_bones(model.sized, model.posture);
  for (geometry::TriangleMesh& bone : bones) {
    for (Vec3& v : bone.vertices) {
      v = model.scan_from_hand * v;
      v += remainder.at_point(v);
    }
  }
  return bones;
}

}  // namespace palmar::capture
