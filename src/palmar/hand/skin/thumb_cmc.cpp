// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/thumb_cmc.h"

#include <algorithm>
#include <cmath>

#include "palmar/geometry/degrees.h"

namespace palmar::hand {
namespace {

// Active flexion-extension arc 53 degrees (Cooney et al. 1981), shared between the two senses as
// the passive ranges 21.7 and 19.5 degrees are (normative passive range, PMID 28478845).
constexpr double kFlexionDeg = 27.9, kExtensionDeg = 25.1;
// From the plane of the palm: anteposition 61.2 degrees (Barakat et al., active, 100 healthy
// adults).
constexpr double kAbductionDeg = 61.2, kAdductionDeg = 0.0;

CmcLimit limit_about(const JointDof& dof, const Vec3& joint_centre, double angle) {
  CmcLimit limit;
  limit.q = Quat(Eigen::AngleAxisd(angle - dof.reference, dof.axis));
  const Vec3 arm = dof.centre - joint_centre;
  limit.t = arm - limit.q * arm;
  return limit;
}

}  // namespace

Joint make_cmc_joint(const Vec3& centre, const Vec3& mp, const CmcAxes& axes) {
  const Vec3 metacarpal = (mp - centre).normalized();
  Joint joint;
  joint.id = JointId::kThumbCmc;
  joint.centre = centre;

  JointDof abduction;
  abduction.dof = Dof::kThumbCmcAbduction;
  abduction.axis = axes.abduction_axis.normalized();
  abduction.centre = centre + axes.abduction_offset;
  // Turning about the axis until the metacarpal lies in the plane of the palm (z = 0): its z is
  // a cos(angle) + b sin(angle) + c; the axis is nearly in that plane, so the elevation angle
  // serves.
  const Vec3 along = metacarpal - metacarpal.dot(abduction.axis) * abduction.axis;
  abduction.reference = std::asin(std::clamp(along.normalized().z(), -1.0, 1.0));
  abduction.lower = std::min(kAdductionDeg * geometry::kDegree, abduction.reference);
  abduction.upper = std::max(kAbductionDeg * geometry::kDegree, abduction.reference);
  abduction.source =
      "axis: Mirakhorlo et al. 2016, table 3; range: plane of the palm to anteposition 61.2 deg "
      "(Barakat et al., active, 100 healthy adults)";

  JointDof flexion;
  flexion.dof = Dof::kThumbCmcFlexion;
  flexion.axis = axes.flexion_axis.normalized();
  flexion.centre = centre;
  flexion.reference = 0.0;
  flexion.lower = -kExtensionDeg * geometry::kDegree;
  flexion.upper = kFlexionDeg * geometry::kDegree;
  flexion.source =
      "axis: Mirakhorlo et al. 2016, table 3; range: active arc 53 deg (Cooney et al. 1981), "
      "shared "
      "21.7 : 19.5 (PMID 28478845) about the template's posture";

  joint.dofs = {abduction, flexion};
  return joint;
}

ThumbCmc make_cmc_limits(const Joint& cmc) {
  const JointDof& abduction = cmc.dofs.at(0);
  const JointDof& flexion = cmc.dofs.at(1);
  return {.flexion = limit_about(flexion, cmc.centre, flexion.upper),
          .extension = limit_about(flexion, cmc.centre, flexion.lower),
          .abduction = limit_about(abduction, cmc.centre, abduction.upper),
          .adduction = limit_about(abduction, cmc.centre, abduction.lower)};
}

}  // namespace palmar::hand
