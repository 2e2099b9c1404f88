// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/hand_from_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hands/capture/hand_plausibility.h"
#include "hands/capture/length_plausibility.h"
#include "hands/capture/marker_matching.h"
#include "hands/capture/mri/bones/bone_chain.h"
#include "hands/capture/scan/bound_dots.h"
#include "hands/capture/scan/dotted_joints.h"
#include "hands/capture/scan/dotted_thumb.h"
#include "hands/capture/scan/missing_marks.h"
#include "hands/capture/scan/ring_bands.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/cluster_vertices.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/skin/drawn_creases.h"
#include "palmar/hand/skin/hand_points.h"

namespace palmar::capture {
namespace {

constexpr double kLookUpEdge = 1.2;  // mm; of the mesh that is fitted to

/// A scan as fits look at it.
geometry::TriangleMesh looked_up(const geometry::TriangleMesh& mesh) {
  constexpr int kMany = 60'000;
  return mesh.triangle_count() > kMany ? geometry::cluster_vertices(mesh, kLookUpEdge) : mesh;
}

MeasuredJoints joints_of(const PlacedSkeleton& placed_model) {
  MeasuredJoints joints;
  joints.skeleton = placed_model.skeleton;
  joints.patient_from_hand = placed_model.scan_from_hand;
  return joints;
}

ScanSurfaces surfaces_of(const SurfaceScan& scan, const hand::Hand& model) {
  ScanSurfaces surfaces;
  surfaces.skin = looked_up(scan.skin);
  surfaces.side = model.side;
  return surfaces;
}

ScannedHand register_model(const hand::Hand& model, const SurfaceScan& scan,
                           const MeasuredJoints& joints, const Progress& progress) {
  return make_scanned_hand(model, {{hand::ScanPosture::kReference, surfaces_of(scan, model)}},
                           joints, progress);
}

/// Joints of one other scan, from the palm outwards.
class DotReader {
 public:
  DotReader(const hand::Hand& hand, const std::vector<BoundDot>& dots, MeasuredJoints& joints,
            HandFromScan& result)
      : hand_(hand), dots_(dots), joints_(joints), result_(result) {}

  void read(hand::ScanPosture name, const SurfaceScan& scan, const hand::MeshFit& fit) {
    name_ = name;
    posture_ = fit.posture;
    const auto found = find_dots(scan, fit);
    dots_sd_ = noise_of(found);
    const geometry::Rigid3 palm = palm_motion(found, fit);
    result_.scan_from_hand[name] = palm;
    read_thumb_of(palm, found);
    for (int f = 1; f < hand::kFingerCount && !is_thumb_limit(name); ++f) {
      geometry::Rigid3 before = palm;
      is_found_by_dots_ = true;
      for (const auto& segment : hand::segments_of(static_cast<hand::Finger>(f))) {
        if (segment) before = before * read_joint(*segment, before, found);
      }
    }
    result_.postures[name] = posture_;
  }

  /// Axes about which dots and skin disagree, once per joint.
  void note_conflicts() const {
    for (const std::string& conflict : conflicts_) {
      if (!conflict.empty()) result_.notes.push_back(conflict);
    }
  }

 private:
  static std::string conflict_note(hand::Segment segment, const DotHinge& hinge,
                                   const HingePrior& prior) {
    if (!hinge.is_conflict) return {};
    const bool is_alone = hinge.dots_error < prior.axis_sd;
    return fmt::format(
        "The dots on {} turn about an axis {:.0f} degrees from that of the skin, known to {:.0f} "
        "degrees by the dots: {}.",
        name_of(segment), hinge.dots_tilt / geometry::kDegree, hinge.dots_error / geometry::kDegree,
        is_alone ? "the dots' was taken; look at whether they were found rightly"
                 : "one between both was taken; dots farther apart, or a larger turn, would tell");
  }
  /// The thumb, whose metacarpal has no dots of its own.
  void read_thumb_of(const geometry::Rigid3& palm, const std::vector<std::optional<Vec3>>& found) {
    ThumbDots dots;
    const geometry::Rigid3 in_hand = palm.inverse();
    for (std::size_t k = 0; k < dots_.size(); ++k) {
      if (!found[k]) continue;
      if (dots_[k].segment == hand::Segment::kThumbProximal) {
        dots.x_proximal.push_back(dots_[k].point);
        dots.y_proximal.push_back(in_hand * *found[k]);
      } else if (dots_[k].segment == hand::Segment::kThumbDistal) {
        dots.x_distal.push_back(dots_[k].point);
        dots.y_distal.push_back(in_hand * *found[k]);
      }
    }
    const ThumbReading reading = read_thumb(dots, hand_.skeleton, posture_);
    posture_[hand::Dof::kThumbMpFlexion] = reading.mp;
    posture_[hand::Dof::kThumbIpFlexion] = reading.ip;
    result_.thumb[name_] = reading;
    geometry::Rigid3 before = palm * reading.metacarpal;
    is_found_by_dots_ = true;
    for (const hand::Segment segment :
         {hand::Segment::kThumbProximal, hand::Segment::kThumbDistal}) {
      before = before * read_joint(segment, before, found);
    }
  }

  /// Where each dot is in the scan.
  std::vector<std::optional<Vec3>> find_dots(const SurfaceScan& scan, const hand::MeshFit& fit) {
    std::vector<hand::HandPoint> points;
    for (const BoundDot& dot : dots_) points.push_back(dot.on_hand);
    std::vector<Vec3> expected = hand::PosablePoints(hand_, points).pose(fit.posture);
    for (Vec3& p : expected) p = fit.mesh_from_hand * p;
    std::vector<std::optional<Vec3>> found(dots_.size());
    std::vector<std::optional<hand::Segment>> taken(scan.marks.dots.size());
    const auto match = [&](std::optional<hand::Segment> segment, double gate, double last_gate) {
      std::vector<std::size_t> of_expected, of_seen;
      std::vector<Vec3> a, b;
      for (std::size_t k = 0; k < dots_.size(); ++k) {
        if (found[k] || (segment && dots_[k].segment != *segment)) continue;
        of_expected.push_back(k);
        a.push_back(expected[k]);
      }
      for (std::size_t k = 0; k < taken.size(); ++k) {
        if (scan.marks.dots[k].segment != segment) continue;
        of_seen.push_back(k);
        b.push_back(scan.marks.dots[k].point);
      }
      if (a.empty() || b.empty()) return;
      MarkerMatchOptions options;
      options.gate = gate;
      options.last_gate = last_gate;
      const auto pairs = match_markers(a, b, options);
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (!pairs[k]) continue;
        const std::size_t seen = of_seen[*pairs[k]];
        found[of_expected[k]] = scan.marks.dots[seen].point;
        taken[seen] = dots_[of_expected[k]].segment;
      }
    };
    // Those whose segment the user named come first: they may be farther off.
    for (int s = 0; s < hand::kSegmentCount; ++s) match(static_cast<hand::Segment>(s), 25.0, 12.0);
    match({}, 10.0, 4.0);
    std::map<hand::Segment, int> again;
    for (const auto& segment : taken) {
      if (segment) ++again[*segment];
    }
    const std::string missing_note = missing_dots_note(scan.name, again, result_.dots);
    if (!missing_note.empty()) result_.notes.push_back(missing_note);
    for (std::size_t k = 0; k < taken.size(); ++k) {
      result_.marks.push_back(
          {name_, hand::MarkLabel::Kind::kDot, taken[k], scan.marks.dots[k].point});
    }
    return found;
  }

  /// Of the dots that were found, by what every segment's own ones show.
  double noise_of(const std::vector<std::optional<Vec3>>& found) const {
    std::vector<DotGroup> groups(hand::kSegmentCount);
    for (std::size_t k = 0; k < dots_.size(); ++k) {
      if (!found[k] || dots_[k].slides) continue;
      DotGroup& group = groups[index_of(dots_[k].segment)];
      group.before.push_back(dots_[k].point);
      group.after.push_back(*found[k]);
    }
    return noise_of_dots(groups);
  }

  geometry::Rigid3 palm_motion(const std::vector<std::optional<Vec3>>& found,
                               const hand::MeshFit& fit) const {
    std::vector<Vec3> a, b;
    for (std::size_t k = 0; k < dots_.size(); ++k) {
      if (dots_[k].segment != hand::Segment::kPalm || !found[k]) continue;
      a.push_back(dots_[k].point);
      b.push_back(*found[k]);
    }
    constexpr std::size_t kEnough = 5;
    return a.size() < kEnough ? fit.mesh_from_hand : align_points_robustly(a, b, 2.0);
  }

  /// Motion of the part behind a joint against the part before it.
  geometry::Rigid3 read_joint(hand::Segment segment, const geometry::Rigid3& before,
                              const std::vector<std::optional<Vec3>>& found) {
    hand::Joint& joint = joints_.skeleton.joints[index_of(hand::joint_of(segment))];
    const hand::Joint& of_skin = hand_.skeleton.joint(hand::joint_of(segment));
    const hand::JointDof& bends = of_skin.dofs.back();
    geometry::Rigid3 spread;
    if (of_skin.dofs.size() == 2) {
      const hand::JointDof& s = of_skin.dofs.front();
      spread = geometry::Rigid3::about_axis(s.axis, s.centre, posture_[s.dof] - s.reference);
    }
    std::vector<Vec3> x, y;
    const geometry::Rigid3 in_part = before.inverse();
    for (std::size_t k = 0; k < dots_.size(); ++k) {
      if (dots_[k].segment != segment || dots_[k].slides || !found[k]) continue;
      x.push_back(spread * dots_[k].point);
      y.push_back(in_part * *found[k]);
    }
    HingePrior prior;
    prior.axis = bends.axis;
    prior.point = bends.centre;
    prior.turn = posture_[bends.dof] - bends.reference;
    constexpr std::size_t kEnough = 2;
    // Dots behind a part whose own dots weren't found see its error, too.
    constexpr double kBySkinSd = 3.0;  // mm
    prior.dot_sd = is_found_by_dots_ ? dots_sd_ : kBySkinSd;
    is_found_by_dots_ = x.size() >= kEnough;
    if (!is_found_by_dots_) {
      return geometry::Rigid3::about_axis(prior.axis, prior.point, prior.turn) * spread;
    }
    const DotHinge hinge = fit_dot_hinge(x, y, prior);
    posture_[bends.dof] = bends.reference + hinge.turn;
    DottedJoint report;
    report.segment = segment;
    report.posture = name_;
    report.turn = hinge.turn;
    report.residual = hinge.residual;
    report.axis_change = std::acos(std::min(1.0, std::abs(hinge.axis.dot(prior.axis))));
    report.centre_change = (hinge.point - prior.point).norm();
    report.axis_error = hinge.axis_error;
    report.dots = static_cast<int>(x.size());
    result_.joints.push_back(report);
    // A turn of 20 degrees or more shows an axis; the largest one shows most.
    constexpr double kLeastTurn = 20.0 * geometry::kDegree;
    double& most = found_by_[index_of(joint.id)];
    if (std::abs(hinge.turn) > std::max(kLeastTurn, most)) {
      most = std::abs(hinge.turn);
      hand::JointDof& dof = joint.dofs.back();
      dof.axis = hinge.axis;
      dof.centre = hinge.point;
      dof.source = "this person's scans";
      joint.centre = hinge.point;
      joints_.is_measured[index_of(dof.dof)] = true;
      conflicts_[index_of(joint.id)] = conflict_note(segment, hinge, prior);
    }
    return geometry::Rigid3::about_axis(hinge.axis, hinge.point, hinge.turn) * spread;
  }

  const hand::Hand& hand_;
  const std::vector<BoundDot>& dots_;
  MeasuredJoints& joints_;
  HandFromScan& result_;
  hand::ScanPosture name_{};
  hand::Posture posture_;
  std::array<double, hand::kJointCount> found_by_{};
  std::array<std::string, hand::kJointCount> conflicts_;  ///< of the axes that were taken; mostly
                                                          ///< empty
  double dots_sd_ = 1.0;                                  // mm, of the scan's dots
  bool is_found_by_dots_ = true;  // where the part before the next joint is, by its own dots
};

/// Ends of the ranges that were scanned as such.
void take_ranges(const std::map<hand::ScanPosture, hand::Posture>& postures, bool has_cmc,
                 hand::Skeleton& skeleton) {
  for (hand::Joint& joint : skeleton.joints) {
    for (hand::JointDof& dof : joint.dofs) {
      // The CMC joint's ranges are its limit postures.
      if (has_cmc && joint.id == hand::JointId::kThumbCmc) continue;
      for (const auto& [name, posture] : postures) {
        dof.lower = std::min(dof.lower, posture[dof.dof]);
        dof.upper = std::max(dof.upper, posture[dof.dof]);
      }
    }
  }
}

/// Finds the person's creases by where the joints suggest them, and moves joints to them.
void take_creases(const SurfaceScan& scan, PlacedSkeleton& placed_model, HandFromScan& result) {
  const hand::Hand& hand = result.scanned.hand;
  const hand::HandCreases suggested(hand.skin, hand.skeleton);
  FoundCreases& found = result.creases;
  const geometry::Rigid3 before = placed_model.scan_from_hand;
  found = find_creases(scan.marks, before.inverse(), suggested);
  shift_to_creases(placed_model, found);
  const geometry::Rigid3 turn = placed_model.scan_from_hand.inverse() * before;
  for (auto& [segment, plane] : found.plane) {
    plane = {turn * plane.point, turn.rotation * plane.normal};
  }
  if (!found.missing.empty()) result.notes.push_back(missing_creases_note(found.missing));
  const auto wrist = found.shift.find(hand::Segment::kPalm);
  if (wrist != found.shift.end() && !found.other_wrist.empty()) {
    const double apart = found.other_wrist.front() - wrist->second;
    result.notes.push_back(fmt::format(
        "Two lines lie near the wrist, {:.0f} mm apart; the one nearer to where the joints suggest "
        "the wrist's crease was taken. With the other the hand would be {:.0f} mm {}. Take watches "
        "and bracelets off, or name the line in a file of marks.",
        std::abs(apart), std::abs(apart), apart < 0.0 ? "longer" : "shorter"));
  }
  constexpr int kMany = 60;
  if (found.stray > kMany) {
    result.notes.emplace_back("Some of what is drawn in the creases' colour is on no crease.");
  }
}

/// Takes rings out of the reference scan: what is under them follows its surroundings.
void leave_out_rings(const PlacedSkeleton& placed_model, SurfaceScan& scan, HandFromScan& result) {
  const std::vector<RingBand> rings = find_rings(
      scan.skin, scan.marks, placed_model.scan_from_hand.inverse(), placed_model.skeleton);
  for (const RingBand& ring : rings) {
    result.notes.push_back(fmt::format(
        "A ring on {}, {:.0f} mm wide, is left out of the scan: the skin under it follows its "
        "surroundings. Take rings off for dimensions of that segment.",
        name_of(ring.segment), ring.width));
  }
  if (!rings.empty()) scan.skin = without_rings(scan.skin, rings);
}

void measure_distances(const SurfaceScan& scan, HandFromScan& result) {
  constexpr double kReach = 5.0;  // mm
  const geometry::ClosestPointQuery query(scan.skin);
  const hand::Hand& hand = result.scanned.hand;
  for (const Vec3& v : hand.skin.vertices) {
    const auto near = query.closest(result.scanned.patient_from_hand * v, kReach);
    result.distance.push_back(near ? near->distance : -1.0);
  }
}

}  // namespace

HandFromScan make_hand_from_scans(const hand::Hand& model,
                                  const std::map<hand::ScanPosture, SurfaceScan>& scans,
                                  std::optional<hand::Side> side, const Progress& progress) {
  const auto reference = scans.find(hand::ScanPosture::kReference);
  if (reference == scans.end()) {
    throw InputError("hand from scans: there is no scan of the reference posture");
  }
  SurfaceScan scan = reference->second;
  HandFromScan result;
  const double others = static_cast<double>(scans.size() - 1);
  const double unit = 1.0 / (4.0 + others);  // laying, registering thrice, one fit each

  PlacedSkeleton placed_model =
      place_skeleton(model, looked_up(scan.skin), side, scan.name, part_of(progress, 0.0, unit));
  const hand::Hand base = placed_model.side == model.side ? model : hand::mirrored(model);
  MeasuredJoints joints = joints_of(placed_model);
  leave_out_rings(placed_model, scan, result);
  result.scanned = register_model(base, scan, joints, part_of(progress, unit, 2.0 * unit));
  double length_by_skin = 0.0;
  if (!scan.marks.lines.empty() || !scan.marks.added_lines.empty()) {
    const double before = result.scanned.hand.dimensions.hand_length;
    take_creases(scan, placed_model, result);
    if (result.creases.shift.contains(hand::Segment::kPalm)) length_by_skin = before;
    joints = joints_of(placed_model);
    // The same skin, seen from the frame that the creases moved.
    result.scanned = register_model(base, scan, joints, part_of(progress, 2.0 * unit, 3.0 * unit));
  } else {
    result.notes.push_back(std::string(scan.marks.is_ink.empty()
                                           ? "No drawn creases"
                                           : "No lines in the creases' colour") +
                           ": segments and joints follow the skin's shape alone, which shows where "
                           "fingers bend to 4 mm in the mean, single fingers to 11 mm.");
  }
  const geometry::Rigid3 hand_from_scan = placed_model.scan_from_hand.inverse();

  // Joints by dots, seen from the hand that the skin gave.
  const hand::Hand& by_skin = result.scanned.hand;
  const std::vector<BoundDot> dots = bind_dots(by_skin, scan.marks, hand_from_scan);
  for (const CreaseMark& mark : result.creases.marks) {
    result.marks.push_back(
        {hand::ScanPosture::kReference, hand::MarkLabel::Kind::kCrease, mark.crease, mark.point});
  }
  for (const BoundDot& dot : dots) {
    ++result.dots[dot.segment];
    result.marks.push_back({hand::ScanPosture::kReference, hand::MarkLabel::Kind::kDot, dot.segment,
                            placed_model.scan_from_hand * dot.point});
  }
  if (!dots.empty()) {
    const std::string missing_note = missing_dots_note(scan.name, result.dots, advised_dots());
    if (!missing_note.empty()) result.notes.push_back(missing_note);
  }
  result.postures[hand::ScanPosture::kReference] = hand::reference_posture(joints.skeleton);
  result.scan_from_hand[hand::ScanPosture::kReference] = placed_model.scan_from_hand;
  DotReader reader(by_skin, dots, joints, result);
  int done = 0;
  for (const auto& [name, other] : scans) {
    if (name == hand::ScanPosture::kReference) continue;
    const double from = (3.0 + done) * unit;
    ++done;
    const hand::MeshFit fit = hand::fit_posture_to_mesh(by_skin, looked_up(other.skin), {},
                                                        part_of(progress, from, from + unit));
    if (fit.status != hand::PostureFitStatus::kFitted) {
      result.notes.push_back(fmt::format("{}: this hand isn't found in it, and it isn't used: {}",
                                         other.name, fit.message));
      continue;
    }
    result.fits[name] = fit;
    reader.read(name, other, fit);
  }
  reader.note_conflicts();
  joints.postures = result.postures;
  take_thumb_readings(by_skin, result.thumb, joints);
  result.postures = joints.postures;
  result.notes.insert(result.notes.end(), joints.notes.begin(), joints.notes.end());
  const bool has_cmc = joints.is_measured[index_of(hand::Dof::kThumbCmcFlexion)] ||
                       joints.is_measured[index_of(hand::Dof::kThumbCmcAbduction)];
  take_ranges(result.postures, has_cmc, joints.skeleton);
  joints.patient_from_hand_in = result.scan_from_hand;
  if (done == 0) {
    result.notes.emplace_back(
        "Only the reference posture was scanned: joints' axes are the model's, as the skin carries "
        "them, their ranges the model's.");
  } else if (dots.empty()) {
    result.notes.emplace_back(
        "No dots were found on the reference scan: joints' axes are the model's, as the skin "
        "carries them.");
  }

  std::map<hand::ScanPosture, ScanSurfaces> surfaces{
      {hand::ScanPosture::kReference, surfaces_of(scan, base)}};
  for (const auto& [name, reading] : result.thumb) {
    if (is_thumb_limit(name)) surfaces[name] = surfaces_of(scans.at(name), base);
  }
  result.scanned = make_scanned_hand(base, surfaces, joints, part_of(progress, 1.0 - unit, 1.0));
  hand::Hand& hand = result.scanned.hand;
  const hand::HandCreases creases =
      hand::creases_of(hand.skin, hand.skeleton, result.creases.plane);
  hand.dimensions = hand::measure_hand(hand.skin, hand.skeleton, creases);
  result.tape = hand::measure_with_tape(hand.skin, hand.skeleton, creases);
  measure_distances(scan, result);
  result.notes.insert(result.notes.end(), result.scanned.notes.begin(), result.scanned.notes.end());
  const std::vector<std::string> impossible =
      impossible_dimensions(hand.dimensions, model.dimensions);
  if (!impossible.empty()) {
    throw InputError(fmt::format(
        "{}: what comes out is no hand: {}. Joints or skin were found wrongly: draw the creases, "
        "name them in a file of marks, or mend the scan",
        scan.name, fmt::join(impossible, "; ")));
  }
  const std::string doubt = length_doubt(hand.dimensions, length_by_skin);
  if (!doubt.empty()) result.notes.push_back(doubt);
  return result;
}

PlacedJoints joints_in_scan(const HandFromScan& made, hand::ScanPosture posture) {
  const hand::Skeleton& skeleton = made.scanned.hand.skeleton;
  const hand::PosedSkeleton posed = hand::pose_skeleton(skeleton, made.postures.at(posture));
  const geometry::Rigid3& scan_from_hand = made.scan_from_hand.at(posture);
  PlacedJoints placed;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    geometry::Rigid3 before =
        finger == hand::Finger::kThumb ? scan_from_hand * posed.thumb_metacarpal : scan_from_hand;
    hand::Segment last = hand::Segment::kPalm;
    for (const auto& segment : hand::segments_of(finger)) {
      if (!segment) continue;
      const hand::JointDof& bends = skeleton.joint(hand::joint_of(*segment)).dofs.back();
      placed.joint[*segment] = {before.rotation * bends.axis, before * bends.centre};
      before = scan_from_hand * posed.segment[index_of(*segment)];
      last = *segment;
    }
    placed.fingertip[last] = before * skeleton.fingertips[f];
  }
  return placed;
}

}  // namespace palmar::capture
