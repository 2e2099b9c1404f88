// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "palmar/capture/axis_fit.h"
#include "palmar/capture/bone_chain.h"
#include "palmar/capture/measured_joints.h"
#include "palmar/capture/reference_hand.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/closest_point.h"
#include "palmar/geometry/mesh_measures.h"
#include "palmar/geometry/smooth.h"

namespace palmar {
namespace {

// A bone that is the right one fits within a few tenths of a millimetre and stays in its joint.
constexpr double kGoodMean = 0.8;      // mm
constexpr double kAliasMean = 0.55;    // mm
constexpr double kPoorMean = 1.6;      // mm; beyond, it isn't this bone
constexpr double kLargestGap = 7.0;    // mm that a joint may come apart between two postures
constexpr double kLargestHead = 10.0;  // mm; radius of a metacarpal's head
constexpr double kLargestShift = 7.0;  // mm that a bone of the palm may shift against the others
constexpr double kLargestTurn = 0.6;   // rad; likewise

/// Size of a bone: root mean square extents along its principal axes, ascending.
Vec3 extents_of(const TriangleMesh& mesh) {
  const std::array<Vec3, 6> p = moment_points(mesh);
  return 0.5 * Vec3((p[0] - p[1]).norm(), (p[2] - p[3]).norm(), (p[4] - p[5]).norm());
}

/// Direction of a bone's greatest extent, either way.
Vec3 long_axis(const TriangleMesh& mesh) {
  const std::array<Vec3, 6> p = moment_points(mesh);
  return (p[4] - p[5]).normalized();
}

bool has_size_of(const Vec3& a, const Vec3& b) {
  return ((a - b).cwiseAbs().array() < 0.35 * a.cwiseMax(b).array() + 0.5).all();
}

/// A bone of the posture's scan that may be the one looked for.
struct Target {
  const ScannedBone* bone = nullptr;
  TriangleMesh mesh;  ///< without the roughness of noise, which registration would lock into
  Vec3 centre = Vec3::Zero();
  Vec3 extents = Vec3::Zero();
};

struct Found {
  IcpResult fit;
  const Target* target = nullptr;
  double gap = 0.0;  ///< how far the joint came apart, or the bone shifted in the palm, mm
  bool is_plausible = false;
};

class BoneTracker {
 public:
  BoneTracker(const ScanSurfaces& reference, const ScanSurfaces& posture, const Progress& progress)
      : reference_(reference), progress_(progress) {
    for (ScannedBone& bone : reference_.bones) bone.mesh = smooth_taubin(bone.mesh);
    for (const ScannedBone& bone : posture.bones) {
      if (!(surface_area(bone.mesh) > 0.0)) continue;
      TriangleMesh mesh = smooth_taubin(bone.mesh);
      const Vec3 centre = centre_of_volume(mesh), extents = extents_of(mesh);
      targets_.push_back({&bone, std::move(mesh), centre, extents});
    }
  }

  std::vector<BoneMotion> track() {
    progress_.update(0.0, "palm");
    place_palm();
    std::vector<const ScannedBone*> palm;
    for (const ScannedBone& bone : reference_.bones) {
      if (is_palm_bone(bone.name) || is_forearm_bone(bone.name)) palm.push_back(&bone);
    }
    std::vector<std::optional<Found>> in_palm(palm.size());
    parallel_for(static_cast<int>(palm.size()), [&](int k) {
      const auto i = static_cast<std::size_t>(k);
      in_palm[i] = find_in_palm(*palm[i]);
    });
    for (std::size_t i = 0; i < palm.size(); ++i) keep(palm[i]->name, in_palm[i]);
    progress_.update(0.4, "fingers");
    std::array<std::vector<std::pair<std::string, std::optional<Found>>>, kFingerCount> rays;
    parallel_for(kFingerCount, [&](int f) {
      rays[static_cast<std::size_t>(f)] = find_ray(static_cast<Finger>(f));
    });
    for (const auto& ray : rays) {
      for (const auto& [name, found] : ray) keep(name, found);
    }
    return settle();
  }

 private:
  const Target* target_named(const std::string& name) const {
    for (const Target& target : targets_) {
      if (target.bone->name == name) return &target;
    }
    return nullptr;
  }

  void keep(const std::string& name, const std::optional<Found>& found) {
    if (found) found_.emplace_back(name, *found);
  }

  /// One bone of the posture is the counterpart of one bone only: the one that fits better.
  std::vector<BoneMotion> settle() const {
    std::vector<BoneMotion> motions;
    for (const auto& [name, mine] : found_) {
      const bool is_taken = std::any_of(found_.begin(), found_.end(), [&](const auto& other) {
        const auto cost = [](const Found& f) { return f.fit.mean + 0.1 * f.gap; };
        return other.second.target == mine.target && other.first != name &&
               std::pair(cost(other.second), other.first) < std::pair(cost(mine), name);
      });
      if (is_taken) continue;
      motions.push_back({name, mine.target->bone->name, mine.fit.fixed_from_moving, mine.fit});
    }
    return motions;
  }

  void place_palm();
  std::optional<Found> find_in_palm(const ScannedBone& bone) const;
  std::vector<std::pair<std::string, std::optional<Found>>> find_ray(Finger finger) const;
  std::optional<Found> find_distal(const ScannedBone& bone, const ScannedBone* proximal,
                                   const Rigid3& motion, bool is_next) const;

  ScanSurfaces reference_;  ///< smoothed likewise
  const Progress& progress_;
  std::vector<Target> targets_;
  Rigid3 palm_;
  std::vector<std::pair<std::string, Found>> found_;
};

TriangleMesh joined(const std::vector<const TriangleMesh*>& meshes) {
  TriangleMesh all;
  for (const TriangleMesh* mesh : meshes) {
    const int first = all.vertex_count();
    all.vertices.insert(all.vertices.end(), mesh->vertices.begin(), mesh->vertices.end());
    for (const Triangle& t : mesh->triangles) {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return all;
}

void BoneTracker::place_palm() {
  std::vector<Vec3> from, to;
  std::vector<const TriangleMesh*> moving, fixed;
  for (const ScannedBone& bone : reference_.bones) {
    if (!is_palm_bone(bone.name) || bone.is_cut) continue;
    moving.push_back(&bone.mesh);
    if (const Target* target = target_named(bone.name)) {
      from.push_back(centre_of_volume(bone.mesh));
      to.push_back(target->centre);
    }
  }
  for (const Target& target : targets_) {
    if (is_palm_bone(target.bone->name)) fixed.push_back(&target.mesh);
  }
  const bool is_placed = from.size() >= 4;
  if (from.size() < 3) {
    // Hardly a name in common: all bones alike, and a search all round.
    from.clear();
    to.clear();
    for (const ScannedBone& bone : reference_.bones) {
      if (const Target* target = target_named(bone.name)) {
        from.push_back(centre_of_volume(bone.mesh));
        to.push_back(target->centre);
      }
    }
  }
  constexpr double kTolerance = 4.0;  // mm; centres of the same bone in two scans
  if (!from.empty()) palm_ = align_points_robustly(from, to, kTolerance);
  if (moving.empty() || fixed.empty()) return;
  IcpOptions options;
  options.samples = 4000;
  options.trim = 0.3;
  options.start_turn = is_placed ? 0.0 : 1.05;
  const IcpResult fit = register_rigidly(joined(moving), joined(fixed), palm_, options, progress_);
  if (fit.overlap > 0.0) palm_ = fit.fixed_from_moving;
}

std::optional<Found> BoneTracker::find_in_palm(const ScannedBone& bone) const {
  if (!(surface_area(bone.mesh) > 0.0)) return {};
  const bool is_forearm = is_forearm_bone(bone.name);
  const Vec3 centre = centre_of_volume(bone.mesh);
  const Vec3 extents = extents_of(bone.mesh);
  std::optional<Found> best;
  const auto attempt = [&](const Target& target) {
    IcpOptions options;
    // Carpals are nearly round: turned starts would only find their false minima.
    options.start_turn = is_forearm ? 0.6 : 0.0;
    options.trim = bone.is_cut || target.bone->is_cut ? 0.4 : 0.2;
    Found found;
    found.target = &target;
    found.fit = register_rigidly(bone.mesh, target.mesh, palm_, options, progress_);
    const Rigid3& motion = found.fit.fixed_from_moving;
    found.gap = is_forearm ? 0.0 : (motion * centre - palm_ * centre).norm();
    const double turn = motion.rotation.angularDistance(palm_.rotation);
    const double error =
        bone.is_cut || target.bone->is_cut ? found.fit.trimmed_rms : found.fit.mean;
    found.is_plausible = found.fit.overlap > 0.3 && error < kPoorMean &&
                         found.gap < kLargestShift && (is_forearm || turn < kLargestTurn);
    if (!found.is_plausible) return;
    if (!best || found.fit.mean + 0.1 * found.gap < best->fit.mean + 0.1 * best->gap) best = found;
  };
  if (const Target* target = target_named(bone.name)) attempt(*target);
  if (best && best->fit.mean < kGoodMean) return best;
  if (is_forearm) return best;
  for (const Target& target : targets_) {
    if (target.bone->name == bone.name || target.bone->is_cut) continue;
    if ((target.centre - palm_ * centre).norm() > 1.5 * kLargestShift) continue;
    if (has_size_of(extents, target.extents)) attempt(target);
  }
  return best;
}

std::vector<std::pair<std::string, std::optional<Found>>> BoneTracker::find_ray(
    Finger finger) const {
  std::vector<std::pair<std::string, std::optional<Found>>> ray;
  const std::vector<std::string> names = ray_of(finger);
  Rigid3 motion = palm_;
  const ScannedBone* proximal =
      finger == Finger::kThumb ? bone_named(reference_, "trapezium") : nullptr;
  bool is_next = true;  // the bone before this one has been found
  for (const std::string& name : names) {
    const ScannedBone* bone = bone_named(reference_, name);
    if (is_palm_bone(name)) {
      for (const auto& [found_name, found] : found_) {
        if (found_name == name) motion = found.fit.fixed_from_moving;
      }
      proximal = bone;
      continue;
    }
    if (bone == nullptr || !(surface_area(bone->mesh) > 0.0)) {
      is_next = false;
      continue;
    }
    const std::optional<Found> found = find_distal(*bone, proximal, motion, is_next);
    ray.emplace_back(name, found);
    proximal = bone;
    is_next = found.has_value();
    if (found) motion = found->fit.fixed_from_moving;
  }
  return ray;
}

std::optional<Found> BoneTracker::find_distal(const ScannedBone& bone, const ScannedBone* proximal,
                                              const Rigid3& motion, bool is_next) const {
  const Vec3 centre = centre_of_volume(bone.mesh);
  const Vec3 extents = extents_of(bone.mesh);
  const bool has_joint = proximal != nullptr && surface_area(proximal->mesh) > 0.0;
  // What stays where it is when the joint turns: the centre of a long bone's head, and of the
  // saddle about its surface.
  const bool is_saddle = has_joint && proximal->name == "trapezium";
  const Vec3 joint = !has_joint  ? centre
                     : is_saddle ? joint_surface_point(bone.mesh, proximal->mesh)
                                 : head_centre(proximal->mesh, bone.mesh);
  const Vec3 seat = motion * joint;
  std::optional<Found> best;
  const auto attempt = [&](const Target& target) {
    std::vector<std::pair<Rigid3, double>> starts;  // and turns about them
    if (has_joint && is_next) {
      // The joint stays where the proximal bone carries it, and the bone points to where the other
      // scan has it.
      Rigid3 start = motion;
      start.rotation =
          Quat::FromTwoVectors(motion.rotation * (centre - joint), target.centre - seat) *
          motion.rotation;
      start.translation = seat - start.rotation * joint;
      starts = {{start, 0.5}, {start, 1.05}};
    } else {
      // Behind a gap in the chain the bone may lie any way: along the other one, up or down.
      const Vec3 mine = motion.rotation * long_axis(bone.mesh), other = long_axis(target.mesh);
      for (const double sense : {1.0, -1.0}) {
        Rigid3 start = motion;
        start.rotation = Quat::FromTwoVectors(mine, sense * other) * motion.rotation;
        start.translation = target.centre - start.rotation * centre;
        starts.emplace_back(start, 1.05);
      }
    }
    for (const auto& [start, turn] : starts) {
      IcpOptions options;
      options.start_turn = turn;
      options.samples = 2000;
      options.tolerance = 1e-3;
      Found found;
      found.target = &target;
      found.fit = register_rigidly(bone.mesh, target.mesh, start, options, progress_);
      found.gap = has_joint && is_next ? (found.fit.fixed_from_moving * joint - seat).norm() : 0.0;
      // One of another name must fit well: neighbours are nearly alike.
      const double limit = target.bone->name == bone.name ? kPoorMean : kAliasMean;
      found.is_plausible =
          found.fit.overlap > 0.3 && found.fit.mean < limit && found.gap < kLargestGap;
      if (found.is_plausible &&
          (!best || found.fit.mean + 0.1 * found.gap < best->fit.mean + 0.1 * best->gap)) {
        best = found;
      }
      if (is_next && found.fit.mean < kGoodMean) return;
    }
  };
  if (const Target* target = target_named(bone.name)) attempt(*target);
  if (best && best->fit.mean < kGoodMean) return best;
  // Not this one, or there is none of that name: whatever of about that size stands at the joint.
  const double reach = 2.0 * (centre - joint).norm() + kLargestGap;
  for (const Target& target : targets_) {
    if (target.bone->name == bone.name || !has_size_of(extents, target.extents)) continue;
    if (!has_joint || (target.centre - seat).norm() > reach) continue;
    const std::optional<ClosestPoint> near =
        ClosestPointQuery(target.mesh).closest(seat, kLargestGap + kLargestHead);
    if (near || !is_next) attempt(target);
  }
  return best;
}

}  // namespace

std::vector<BoneMotion> track_bones(const ScanSurfaces& reference, const ScanSurfaces& posture,
                                    const Progress& progress) {
  return BoneTracker(reference, posture, progress).track();
}

}  // namespace palmar
