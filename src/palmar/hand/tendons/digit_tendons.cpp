// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/digit_tendons.h"

#include <cmath>
#include <numeric>
#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/hand/tendons/thumb_tendons.h"

namespace palmar::hand {
namespace {

/// Where a tendon is held beside a joint: multiples of the middle phalanx' link O2O3, in the frames
/// of An et al. 1979 (x towards the palm, y dorsal, z radial). The distal frame's origin lies
/// `offset` distally of the joint's centre, the proximal one's in it.
struct Hold {
  double distal_x, distal_y, distal_z, proximal_x, proximal_y, proximal_z;
};

/// All of one finger.
struct Holds {
  Hold dip_terminal, dip_profundus;
  Hold pip_profundus, pip_superficialis, pip_central, pip_radial_band, pip_ulnar_band;
  Hold mcp_profundus, mcp_superficialis, mcp_radial, mcp_lumbrical, mcp_ulnar, mcp_extensor;
};

// An et al. 1979, middle finger, as tabulated by Synek et al. 2019 with the ulnar interosseous'
// proximal y corrected.
constexpr Holds kAn1979 = {.dip_terminal = {-0.05, 0.154, -0.022, 0.0, 0.168, -0.015},
                           .dip_profundus = {-0.05, -0.141, 0.032, 0.3, -0.254, 0.033},
                           .pip_profundus = {-0.28, -0.273, -0.004, 0.4, -0.266, -0.004},
                           .pip_superficialis = {-0.28, -0.207, 0.001, 0.4, -0.217, -0.016},
                           .pip_central = {-0.03, 0.247, -0.024, 0.0, 0.236, -0.019},
                           .pip_radial_band = {-0.18, 0.172, 0.227, 0.1, 0.1, 0.242},
                           .pip_ulnar_band = {-0.18, 0.161, -0.247, 0.1, 0.076, -0.279},
                           .mcp_profundus = {-0.18, -0.33, 0.023, 0.3, -0.47, 0.012},
                           .mcp_superficialis = {-0.18, -0.393, 0.039, 0.3, -0.574, 0.019},
                           .mcp_radial = {-0.38, -0.038, 0.331, 0.4, -0.565, 0.471},
                           .mcp_lumbrical = {-0.38, -0.14, 0.328, 0.4, -0.623, 0.422},
                           .mcp_ulnar = {-0.38, 0.036, -0.357, 0.4, -0.264, -0.358},
                           .mcp_extensor = {-0.08, 0.322, -0.018, 0.0, 0.393, -0.039}};

// Synek et al. 2019: the same, moved until the forces at the tips of three middle fingers came out.
constexpr Holds kSynek2019 = {
    .dip_terminal = {-0.0500, 0.1539, -0.022, 0.0002, 0.1575, -0.015},
    .dip_profundus = {0.0352, -0.1277, 0.032, 0.2926, -0.2780, 0.033},
    .pip_profundus = {-0.2859, -0.2875, -0.004, 0.4157, -0.2905, -0.004},
    .pip_superficialis = {-0.2640, -0.1627, 0.001, 0.3316, -0.1328, -0.016},
    .pip_central = {-0.0300, 0.2473, -0.024, -0.0004, 0.2306, -0.019},
    .pip_radial_band = {-0.1805, 0.1698, 0.227, 0.1017, 0.0922, 0.242},
    .pip_ulnar_band = {-0.1802, 0.1613, -0.247, 0.1020, 0.0786, -0.279},
    .mcp_profundus = {-0.2323, -0.3143, 0.023, 0.3854, -0.5175, 0.012},
    .mcp_superficialis = {-0.3244, -0.2938, 0.039, 0.4871, -0.5610, 0.019},
    .mcp_radial = {-0.3125, 0.0701, 0.331, 0.2693, -0.1842, 0.471},
    .mcp_lumbrical = {-0.3700, -0.1160, 0.328, 0.4107, -0.5980, 0.422},
    .mcp_ulnar = {-0.3681, 0.0441, -0.357, 0.3880, -0.2397, -0.358},
    .mcp_extensor = {-0.0687, 0.2656, -0.018, 0.0553, 0.4089, -0.039}};

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
    return hand.dimensions.segment[index_of(*segments[0])].width +
           hand.dimensions.segment[index_of(*segments[1])].width;
  };
  const double middle = width(Finger::kMiddle), own = width(finger);
  return middle > 0.0 && own > 0.0 ? own / middle : 1.0;
}

DigitTendons route_finger_tendons(const Hand& hand, Finger finger, const TendonModel& model) {
  const Holds& holds = model.points == FingerPoints::kAn1979 ? kAn1979 : kSynek2019;
  const ExtensorHood& hood = model.hood;
  const auto segments = segments_of(finger);
  const JointId mcp_id = joint_of(*segments[0]), pip_id = joint_of(*segments[1]),
                dip_id = joint_of(*segments[2]);
  const auto centre = [&](JointId id) { return hand.skeleton.joint(id).centre; };
  const double link =
      (centre(JointId::kMiddleDip) - centre(JointId::kMiddlePip)).norm() / (1.0 + kPipOffset);
  const double scale = link * relative_width(hand, finger);

  const JointFrames mcp = frames_at(hand, mcp_id, centre(pip_id), 0, kMcpOffset);
  const JointFrames pip = frames_at(hand, pip_id, centre(dip_id), mcp.distal_body, kPipOffset);
  const JointFrames dip = frames_at(hand, dip_id, hand.skeleton.fingertips[index_of(finger)],
                                    pip.distal_body, kDipOffset);
  const auto wrapped = [&](const JointFrames& at, const Hold& hold, double share) {
    return span_at(at, hold, scale, share, Line::kWrapped);
  };
  const auto straight = [&](const JointFrames& at, const Hold& hold, double share) {
    return span_at(at, hold, scale, share, Line::kStraight);
  };
  const auto with_hood = [&](TendonSpan at_mcp, const HoodShare& share) {
    TendonPath path = {std::move(at_mcp)};
    if (share.central > 0.0) path.push_back(wrapped(pip, holds.pip_central, share.central));
    if (share.radial > 0.0) path.push_back(straight(pip, holds.pip_radial_band, share.radial));
    if (share.ulnar > 0.0) path.push_back(straight(pip, holds.pip_ulnar_band, share.ulnar));
    const double terminal = share.radial + share.ulnar;
    if (terminal > 0.0) path.push_back(wrapped(dip, holds.dip_terminal, terminal));
    return path;
  };

  // In the order of tendons_of().
  return {finger,
          {{wrapped(mcp, holds.mcp_profundus, 1.0), wrapped(pip, holds.pip_profundus, 1.0),
            wrapped(dip, holds.dip_profundus, 1.0)},
           {wrapped(mcp, holds.mcp_superficialis, 1.0), wrapped(pip, holds.pip_superficialis, 1.0)},
           with_hood(wrapped(mcp, holds.mcp_extensor, 1.0), hood.edc),
           with_hood(straight(mcp, holds.mcp_lumbrical, 1.0), hood.lumbrical),
           with_hood(straight(mcp, holds.mcp_radial, 1.0), hood.radial_interosseous),
           with_hood(straight(mcp, holds.mcp_ulnar, 1.0), hood.ulnar_interosseous)}};
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

ExtensorHood chao1989_hood() {
  return {.edc = {0.167, 0.167, 0.167},
          .lumbrical = {0.333, 0.667, 0.0},
          .radial_interosseous = {0.133, 0.133, 0.0},
          .ulnar_interosseous = {0.313, 0.0, 0.313}};
}

void ExtensorHood::check() const {
  check_share("extensor digitorum", edc);
  check_share("lumbrical", lumbrical);
  check_share("radial interosseous", radial_interosseous);
  check_share("ulnar interosseous", ulnar_interosseous);
}

DigitTendons route_tendons(const Hand& hand, Finger finger, const TendonModel& model) {
  model.hood.check();
  if (finger == Finger::kThumb) return route_thumb_tendons(hand);
  return route_finger_tendons(hand, finger, model);
}

std::vector<std::array<double, kDigitDofs>> moment_arms(const DigitTendons& tendons,
                                                        const PosedDigit& digit) {
  std::vector<std::array<double, kDigitDofs>> arms;
  arms.reserve(tendons.path.size());
  for (const TendonPath& path : tendons.path) arms.push_back(moment_arms(path, digit));
  return arms;
}

}  // namespace palmar::hand
