// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/thumb_tendons.h"

#include <algorithm>
#include <array>

namespace palmar::hand {
namespace {

/// A point of the tables (X radial, Y proximal, Z dorsal; mm) in the hand frame's directions.
Vec3 specimen(double x, double y, double z) { return {x, -y, -z}; }

// Landmarks of the specimen (table 4): base of the first metacarpal, radial and ulnar side of MP
// and IP, tip of the distal phalanx, midway between the styloids; middle of the four fingers' MCP
// joints (table 3).
const Vec3 kBase = specimen(61.8, -22.6, -14.1);
const Vec3 kMpRadial = specimen(77.7, -62.7, -18.1), kMpUlnar = specimen(70.9, -67.0, 3.5);
const Vec3 kIpRadial = specimen(94.4, -85.7, -8.3), kIpUlnar = specimen(84.7, -90.5, 8.4);
const Vec3 kTip = specimen(104.4, -114.0, -1.4);
const Vec3 kWrist = specimen(25.85, 0.85, 0.0), kKnuckles = specimen(22.20, -87.64, -1.04);
// Cylinders fitted to the joint surfaces (table 6), mm.
constexpr double kMpRadius = 6.66, kIpRadius = 6.55;

enum ThumbBone { kPalm, kMetacarpal, kProximal, kDistal };  // = body of the digit

struct SpecimenPoint {
  ThumbBone bone;
  double x, y, z;
};

/// One head of a muscle, from the palm outwards.
struct Head {
  Tendon tendon;
  double share;
  std::vector<SpecimenPoint> points;
};

// Table 7. Muscles with broad origins run as several heads of equal share. Points on the radius
// (the table's last ones of the long tendons) are taken as fixed to the palm. Left out: the point
// of the deep flexor brevis that the table has 12 cm off the hand, and that of the long flexor at
// the level of the IP joint, from which the chord to the insertion would pass the axis in deep
// flexion.
const std::vector<Head>& heads() {
  static const std::vector<Head> all = {
      {Tendon::kFpl,
       1.0,
       {{kPalm, 37.9, -22.3, -20.9},
        {kMetacarpal, 59.4, -63.6, -15.6},
        {kProximal, 74.1, -78.5, -9.1},
        {kDistal, 87.5, -96.9, -1.0}}},
      {Tendon::kFpb, 0.5, {{kPalm, 29.1, -42.3, -17.1}, {kProximal, 74.0, -68.1, -18.9}}},
      {Tendon::kFpb, 0.5, {{kPalm, 31.9, -32.1, -13.2}, {kProximal, 70.5, -71.5, -15.8}}},
      {Tendon::kApb, 1.0 / 3.0, {{kPalm, 32.2, -44.5, -16.4}, {kProximal, 81.4, -65.0, -15.4}}},
      {Tendon::kApb, 1.0 / 3.0, {{kPalm, 28.3, -30.8, -21.8}, {kProximal, 81.4, -65.0, -15.4}}},
      {Tendon::kApb, 1.0 / 3.0, {{kPalm, 34.1, -20.6, -23.4}, {kProximal, 81.4, -65.0, -15.4}}},
      {Tendon::kOpp, 0.5, {{kPalm, 38.9, -22.3, -23.6}, {kMetacarpal, 76.6, -60.9, -16.2}}},
      {Tendon::kOpp, 0.5, {{kPalm, 29.7, -29.3, -20.7}, {kMetacarpal, 63.3, -29.3, -18.9}}},
      {Tendon::kAdp, 0.25, {{kPalm, 26.4, -67.7, -2.3}, {kProximal, 68.1, -74.2, -5.7}}},
      {Tendon::kAdp, 0.5, {{kPalm, 28.6, -37.2, -9.4}, {kProximal, 68.1, -74.2, -5.7}}},
      {Tendon::kAdp, 0.25, {{kPalm, 31.9, -32.1, -13.2}, {kProximal, 68.1, -74.2, -5.7}}},
      {Tendon::kEpl,
       1.0,
       {{kPalm, 36.6, -3.4, 5.3},
        {kMetacarpal, 59.0, -31.3, -4.4},
        {kMetacarpal, 73.2, -53.4, -0.7},
        {kProximal, 90.3, -76.7, -1.1},
        {kDistal, 106.8, -94.6, -7.5}}},
      {Tendon::kEpb,
       1.0,
       {{kPalm, 52.2, 5.5, -4.7},
        {kMetacarpal, 65.9, -29.3, -13.5},
        {kMetacarpal, 77.4, -53.0, -6.7},
        {kProximal, 81.7, -66.0, -16.4}}},
      {Tendon::kApl, 1.0, {{kPalm, 51.3, 5.8, -5.7}, {kMetacarpal, 65.9, -29.7, -17.6}}}};
  return all;
}

/// Frame of a bone: along it, perpendicular to that on the flexion side, and the flexion axis.
struct BoneFrame {
  Vec3 origin = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double length = 0.0;
};

BoneFrame bone_frame(const Vec3& from, const Vec3& to, const Vec3& flexion_axis) {
  BoneFrame frame;
  frame.origin = from;
  frame.length = (to - from).norm();
  frame.axes.col(0) = (to - from) / frame.length;
  const Vec3 square = flexion_axis - flexion_axis.dot(frame.axes.col(0)) * frame.axes.col(0);
  frame.axes.col(2) = square.normalized();
  frame.axes.col(1) = frame.axes.col(2).cross(frame.axes.col(0));
  return frame;
}

using BoneFrames = std::array<BoneFrame, 4>;

BoneFrames specimen_frames() {
  const Vec3 mp = 0.5 * (kMpRadial + kMpUlnar), ip = 0.5 * (kIpRadial + kIpUlnar);
  BoneFrames frames;
  frames[kPalm].origin = kKnuckles;
  frames[kPalm].length = (kKnuckles - kWrist).norm();
  frames[kMetacarpal] = bone_frame(kBase, mp, kMpRadial - kMpUlnar);
  frames[kProximal] = bone_frame(mp, ip, kIpRadial - kIpUlnar);
  frames[kDistal] = bone_frame(ip, kTip, kIpRadial - kIpUlnar);
  return frames;
}

/// A left hand's points are mirrored to a right one's; an axis of rotation also turns round.
Vec3 righted(const Vec3& v, Side side) {
  return side == Side::kRight ? v : Vec3(-v.x(), v.y(), v.z());
}
Vec3 righted_axis(const Vec3& v, Side side) {
  return side == Side::kRight ? v : Vec3(v.x(), -v.y(), -v.z());
}

BoneFrames hand_frames(const Hand& hand) {
  const Skeleton& skeleton = hand.skeleton;
  const auto centre = [&](JointId id) { return righted(skeleton.joint(id).centre, hand.side); };
  const auto axis = [&](Dof dof) { return righted_axis(skeleton.dof(dof).axis, hand.side); };
  const Vec3 mp = centre(JointId::kThumbMp), ip = centre(JointId::kThumbIp);
  BoneFrames frames;
  for (const JointId id :
       {JointId::kIndexMcp, JointId::kMiddleMcp, JointId::kRingMcp, JointId::kLittleMcp}) {
    frames[kPalm].origin += 0.25 * centre(id);
  }
  frames[kPalm].length = (frames[kPalm].origin - centre(JointId::kWrist)).norm();
  // The base of the metacarpal is found from the palm, where the muscles begin: the centre about
  // which a skeleton turns the CMC lies some millimetres away from it.
  const double palm = frames[kPalm].length / (kKnuckles - kWrist).norm();
  const Vec3 base = frames[kPalm].origin + palm * (kBase - kKnuckles);
  frames[kMetacarpal] = bone_frame(base, mp, axis(Dof::kThumbMpFlexion));
  frames[kProximal] = bone_frame(mp, ip, axis(Dof::kThumbIpFlexion));
  frames[kDistal] =
      bone_frame(ip, righted(skeleton.fingertips[0], hand.side), axis(Dof::kThumbIpFlexion));
  return frames;
}

}  // namespace

DigitTendons route_thumb_tendons(const Hand& hand) {
  const BoneFrames from = specimen_frames(), to = hand_frames(hand);
  double own = 0.0, theirs = 0.0;
  for (const ThumbBone bone : {kMetacarpal, kProximal, kDistal}) {
    own += to[bone].length;
    theirs += from[bone].length;
  }
  const double across = own / theirs;
  const auto point_on = [&](const SpecimenPoint& p) {
    const BoneFrame &here = to[p.bone], &there = from[p.bone];
    const double along = here.length / there.length;
    Vec3 local = there.axes.transpose() * (specimen(p.x, p.y, p.z) - there.origin);
    local = p.bone == kPalm ? Vec3(along * local)
                            : Vec3(along * local.x(), across * local.y(), across * local.z());
    return TendonPoint{p.bone, righted(here.origin + here.axes * local, hand.side)};
  };
  // Smaller than fitted where the tendon is held nearer to the axis.
  const auto cylinder = [&](const TendonSpan& span, Dof dof, int body, double radius,
                            double sense) {
    const JointDof& joint = hand.skeleton.dof(dof);
    double largest = across * radius;
    for (const Vec3& p : {span.proximal.point, span.distal.point}) {
      largest = std::min(largest, 0.95 * (p - joint.centre).cross(joint.axis).norm());
    }
    return TendonCylinder{body, joint.centre, joint.axis, largest, sense};
  };

  DigitTendons tendons{Finger::kThumb, {}};
  for (const Tendon tendon : tendons_of(Finger::kThumb)) {
    TendonPath path;
    for (const Head& head : heads()) {
      if (head.tendon != tendon) continue;
      for (std::size_t i = 0; i + 1 < head.points.size(); ++i) {
        const SpecimenPoint &a = head.points[i], &b = head.points[i + 1];
        if (a.bone == b.bone) continue;  // runs along a bone
        TendonSpan span{point_on(a), point_on(b), std::nullopt, head.share};
        const bool is_long =
            tendon == Tendon::kFpl || tendon == Tendon::kEpl || tendon == Tendon::kEpb;
        // Followed outwards an extensor runs right-handed round the flexion axis, a flexor not.
        const double sense = tendon == Tendon::kFpl ? -1.0 : 1.0;
        if (is_long && a.bone == kMetacarpal) {
          span.cylinder = cylinder(span, Dof::kThumbMpFlexion, kMetacarpal, kMpRadius, sense);
        } else if (is_long && a.bone == kProximal) {
          span.cylinder = cylinder(span, Dof::kThumbIpFlexion, kProximal, kIpRadius, sense);
        }
        path.push_back(std::move(span));
      }
    }
    tendons.path.push_back(std::move(path));
  }
  return tendons;
}

}  // namespace palmar::hand
