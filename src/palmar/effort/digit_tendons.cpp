// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/effort/digit_tendons.h"

#include <cmath>
#include <numeric>
#include <string>

#include "palmar/core/error.h"
#include "palmar/effort/thumb_tendons.h"

namespace palmar {
namespace {

/// Where a tendon is held beside a joint: multiples of the middle phalanx' link O2O3, in the frames
/// of An et al. 1979 (x towards the palm, y dorsal, z radial). The distal frame's origin lies
/// `offset` distally of the joint's centre, the proximal one's in it.
struct Hold {
  double distal_x, distal_y, distal_z, proximal_x, proximal_y, proximal_z;
};

constexpr Hold kDipTerminal = {-0.05, 0.154, -0.022, 0.0, 0.168, -0.015};
constexpr Hold kDipProfundus = {-0.05, -0.141, 0.032, 0.3, -0.254, 0.033};
constexpr Hold kPipProfundus = {-0.28, -0.273, -0.004, 0.4, -0.266, -0.004};
constexpr Hold kPipSuperficialis = {-0.28, -0.207, 0.001, 0.4, -0.217, -0.016};
constexpr Hold kPipCentral = {-0.03, 0.247, -0.024, 0.0, 0.236, -0.019};
constexpr Hold kPipRadialBand = {-0.18, 0.172, 0.227, 0.1, 0.1, 0.242};
constexpr Hold kPipUlnarBand = {-0.18, 0.161, -0.247, 0.1, 0.076, -0.279};
constexpr Hold kMcpProfundus = {-0.18, -0.33, 0.023, 0.3, -0.47, 0.012};
constexpr Hold kMcpSuperficialis = {-0.18, -0.393, 0.039, 0.3, -0.574, 0.019};
constexpr Hold kMcpRadial = {-0.38, -0.038, 0.331, 0.4, -0.565, 0.471};
constexpr Hold kMcpLumbrical = {-0.38, -0.14, 0.328, 0.4, -0.623, 0.422};
constexpr Hold kMcpUlnar = {-0.38, 0.036, -0.357, 0.4, -0.264, -0.358};
constexpr Hold kMcpExtensor = {-0.08, 0.322, -0.018, 0.0, 0.393, -0.039};

// O1O2, O3O4, O5O6 over O2O3 (An et al. 1979 by Synek et al. 2019): from the distal frame to the
// centre of DIP, PIP and MCP. PIP and DIP centres are O2O3 + O3O4 apart.
constexpr double kDipOffset = 0.17, kPipOffset = 0.22, kMcpOffset = 0.37;

/// The frames at a joint in the straight finger, and which bodies they belong to.
struct JointFrames {
  Vec3 centre;
  Eigen::Matrix3d distal, proximal;  ///< columns x, y, z of An et al.; reference posture
  int distal_body = 0, proximal_body = 0, cylinder_body = 0;
  Vec3 flexion_axis;
  double offset = 0.0;  ///< of the distal frame, multiples of O2O3
};

bool is_flexion(Dof dof) { return name_of(dof).ends_with("flexion"); }

/// `next`: centre of the next joint, or the fingertip.
JointFrames frames_at(const Hand& hand, JointId id, const Vec3& next, int proximal_body,
                      double offset) {
  const Joint& joint = hand.skeleton.joint(id);
  JointFrames frames;
  frames.centre = joint.centre;
  frames.offset = offset;
  frames.proximal_body = proximal_body;
  frames.distal_body = proximal_body + static_cast<int>(joint.dofs.size());
  // Bodies follow the joint's axes from the palm outwards: the cylinder is held to the one that the
  // flexion axis turns against.
  for (std::size_t d = 0; d < joint.dofs.size(); ++d) {
    if (!is_flexion(joint.dofs[d].dof)) continue;
    frames.flexion_axis = joint.dofs[d].axis;
    frames.cylinder_body = frames.distal_body - 1 - static_cast<int>(d);
  }
  const Vec3& axis = frames.flexion_axis;
  Vec3 along = next - joint.centre;
  along = (along - along.dot(axis) * axis).normalized();
  // Flexion turns the finger to its palmar side; radial is that axis in a right hand.
  frames.distal.col(0) = -along;
  frames.distal.col(1) = -axis.cross(along);
  frames.distal.col(2) = hand.side == Side::kRight ? axis : Vec3(-axis);
  Eigen::Matrix3d to_zero = Eigen::Matrix3d::Identity();
  for (const JointDof& dof : joint.dofs) {
    to_zero = Eigen::AngleAxisd(-dof.reference, dof.axis).toRotationMatrix() * to_zero;
  }
  frames.proximal = to_zero * frames.distal;
  return frames;
}

enum class Line { kStraight, kWrapped };

TendonSpan span_at(const JointFrames& frames, const Hold& hold, double scale, double share,
                   Line line) {
  const Vec3 proximal(hold.proximal_x, hold.proximal_y, hold.proximal_z);
  const Vec3 distal(hold.distal_x - frames.offset, hold.distal_y, hold.distal_z);
  TendonSpan span;
  span.proximal = {frames.proximal_body, frames.centre + scale * (frames.proximal * proximal)};
  span.distal = {frames.distal_body, frames.centre + scale * (frames.distal * distal)};
  span.share = share;
  if (line == Line::kStraight) return span;
  // Distance of the straight finger's line from the axis; x distal, y palmar turn right-handed
  // about the flexion axis.
  const Eigen::Vector2d a = -proximal.head<2>(), b = -distal.head<2>();
  const double arm = (a.x() * b.y() - a.y() * b.x()) / (b - a).norm();
  span.cylinder = TendonCylinder{.body = frames.cylinder_body,
                                 .centre = frames.centre,
                                 .axis = frames.flexion_axis,
                                 .radius = scale * std::abs(arm),
                                 .sense = arm < 0.0 ? -1.0 : 1.0};
  return span;
}

/// Size of a finger's joints against those of the middle finger.
double relative_width(const Hand& hand, Finger finger) {
  const auto width = [&](Finger f) {
    const auto segments = segments_of(f);
    return hand.dimensions.segment[static_cast<std::size_t>(*segments[0])].width +
           hand.dimensions.segment[static_cast<std::size_t>(*segments[1])].width;
  };
  const double middle = width(Finger::kMiddle), own = width(finger);
  return middle > 0.0 && own > 0.0 ? own / middle : 1.0;
}

DigitTendons route_finger_tendons(const Hand& hand, Finger finger, const ExtensorHood& hood) {
  const auto segments = segments_of(finger);
  const JointId mcp_id = joint_of(*segments[0]), pip_id = joint_of(*segments[1]),
                dip_id = joint_of(*segments[2]);
  const auto centre = [&](JointId id) { return hand.skeleton.joint(id).centre; };
  const double link =
      (centre(JointId::kMiddleDip) - centre(JointId::kMiddlePip)).norm() / (1.0 + kPipOffset);
  const double scale = link * relative_width(hand, finger);

  const JointFrames mcp = frames_at(hand, mcp_id, centre(pip_id), 0, kMcpOffset);
  const JointFrames pip = frames_at(hand, pip_id, centre(dip_id), mcp.distal_body, kPipOffset);
  const JointFrames dip =
      frames_at(hand, dip_id, hand.skeleton.fingertips[static_cast<std::size_t>(finger)],
                pip.distal_body, kDipOffset);
  const auto wrapped = [&](const JointFrames& at, const Hold& hold, double share) {
    return span_at(at, hold, scale, share, Line::kWrapped);
  };
  const auto straight = [&](const JointFrames& at, const Hold& hold, double share) {
    return span_at(at, hold, scale, share, Line::kStraight);
  };
  const auto with_hood = [&](TendonSpan at_mcp, const HoodShare& share) {
    TendonPath path = {std::move(at_mcp)};
    if (share.central > 0.0) path.push_back(wrapped(pip, kPipCentral, share.central));
    if (share.radial > 0.0) path.push_back(straight(pip, kPipRadialBand, share.radial));
    if (share.ulnar > 0.0) path.push_back(straight(pip, kPipUlnarBand, share.ulnar));
    const double terminal = share.radial + share.ulnar;
    if (terminal > 0.0) path.push_back(wrapped(dip, kDipTerminal, terminal));
    return path;
  };

  // In the order of tendons_of().
  return {finger,
          {{wrapped(mcp, kMcpProfundus, 1.0), wrapped(pip, kPipProfundus, 1.0),
            wrapped(dip, kDipProfundus, 1.0)},
           {wrapped(mcp, kMcpSuperficialis, 1.0), wrapped(pip, kPipSuperficialis, 1.0)},
           with_hood(wrapped(mcp, kMcpExtensor, 1.0), hood.edc),
           with_hood(straight(mcp, kMcpLumbrical, 1.0), hood.lumbrical),
           with_hood(straight(mcp, kMcpRadial, 1.0), hood.radial_interosseous),
           with_hood(straight(mcp, kMcpUlnar, 1.0), hood.ulnar_interosseous)}};
}

void check_share(const std::string& muscle, const HoodShare& share) {
  for (const double part : {share.central, share.radial, share.ulnar}) {
    if (part >= 0.0 && part <= 1.0) continue;
    throw UsageError("extensor hood: a share of the " + muscle + " is " + std::to_string(part) +
                     "; 0 to 1 is allowed");
  }
  const double sum = share.central + share.radial + share.ulnar;
  if (sum > 1.0 + 1e-9) {
    throw UsageError("extensor hood: the shares of the " + muscle + " add up to " +
                     std::to_string(sum) + "; at most 1 is allowed");
  }
}

}  // namespace

void ExtensorHood::check() const {
  check_share("extensor digitorum", edc);
  check_share("lumbrical", lumbrical);
  check_share("radial interosseous", radial_interosseous);
  check_share("ulnar interosseous", ulnar_interosseous);
}

DigitTendons route_tendons(const Hand& hand, Finger finger, const ExtensorHood& hood) {
  hood.check();
  if (finger == Finger::kThumb) return route_thumb_tendons(hand);
  return route_finger_tendons(hand, finger, hood);
}

std::vector<std::array<double, kDigitDofs>> moment_arms(const DigitTendons& tendons,
                                                        const PosedDigit& digit) {
  std::vector<std::array<double, kDigitDofs>> arms;
  arms.reserve(tendons.path.size());
  for (const TendonPath& path : tendons.path) arms.push_back(moment_arms(path, digit));
  return arms;
}

}  // namespace palmar
