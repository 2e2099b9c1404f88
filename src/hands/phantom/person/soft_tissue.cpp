// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/soft_tissue.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/repair/self_intersection.h"

namespace palmar::phantom {
namespace {

constexpr double kBand = 10.0;        // mm, between bands of constant volume
constexpr double kLeastShare = 0.01;  // smaller shares of a part are dropped
constexpr int kChains = hand::kFingerCount + 1;
constexpr int kPalmChain = hand::kFingerCount;

struct Link {
  int body;
  Vec3 from, to;
};

struct Near {
  double distance;
  Vec3 point;
};

Near near_link(const Link& link, const Vec3& p) {
  const Vec3 along = link.to - link.from;
  const double t = std::clamp(along.dot(p - link.from) / along.squaredNorm(), 0.0, 1.0);
  const Vec3 q = link.from + t * along;
  return {(p - q).norm(), q};
}

// A rigid motion as a dual quaternion.
struct DualQuaternion {
  Eigen::Vector4d real = Eigen::Vector4d::Zero(), dual = Eigen::Vector4d::Zero();
};

DualQuaternion dual_quaternion(const geometry::Rigid3& motion) {
  const Quat& q = motion.rotation;
  const Quat t(0.0, motion.translation.x(), motion.translation.y(), motion.translation.z());
  const Quat d = t * q;
  return {q.coeffs(), 0.5 * d.coeffs()};
}

geometry::Rigid3 rigid(const DualQuaternion& sum) {
  const double length = sum.real.norm();
  const Quat q(Eigen::Vector4d(sum.real / length));
  const Quat d(Eigen::Vector4d(sum.dual / length));
  const Quat t = d * q.conjugate();
  return {q, 2.0 * t.vec()};
}

// Volume between a triangle of skin and the one of its core points: three tetrahedra, cut by the
// vertices' order, so that neighbours share their sides.
double prism_volume(const std::vector<Vec3>& skin, const std::vector<Vec3>& core,
                    const Triangle& t) {
  std::array<int, 3> v = t;
  double sign = 1.0;
  for (const std::array<int, 2>& pair : {std::array{0, 1}, std::array{1, 2}, std::array{0, 1}}) {
    const int a = pair[0], b = pair[1];
    if (v[a] > v[b]) {
      std::swap(v[a], v[b]);
      sign = -sign;
    }
  }
  const Vec3 &s0 = skin[v[0]], &s1 = skin[v[1]], &s2 = skin[v[2]];
  const Vec3 &c0 = core[v[0]], &c1 = core[v[1]], &c2 = core[v[2]];
  const auto det = [](const Vec3& o, const Vec3& a, const Vec3& b, const Vec3& c) {
    return (a - o).cross(b - o).dot(c - o);
  };
  return -sign / 6.0 * (det(s0, s1, s2, c0) + det(s1, s2, c0, c1) + det(s2, c0, c1, c2));
}

}  // namespace

struct SoftTissue::Impl {
  struct Share {
    int body;
    double weight;
  };
  struct Hat {
    int band;
    double weight;
  };

  const SubjectPerson* person;
  const std::vector<SubjectBone>* bones;
  std::vector<Link> links;
  std::vector<int> nearest;   ///< body per vertex
  std::vector<double> depth;  ///< distance to its axis, mm
  std::vector<Vec3> core_point;
  std::vector<std::vector<Share>> share;
  std::vector<std::vector<Hat>> hat;
  std::vector<std::vector<int>> neighbour;
  std::vector<double> band_volume;
  std::vector<std::array<int, 2>> neighbour_band;
  std::vector<std::unique_ptr<geometry::MeshDistance>> bone_distance;
  Vec3 ball, ball_radial, web;  ///< places of the thumb ball's swelling, reference
  Vec3 towards_wrist;           ///< along the thumb's metacarpal
  int ball_vertex = 0;
  double size = 1.0;  ///< of the hand, over 180 mm

  explicit Impl(const SubjectPerson& p, const std::vector<SubjectBone>& b) : person(&p), bones(&b) {
    place_links();
    find_nearest();
    neighbour = geometry::vertex_neighbours(geometry::build_topology(p.skin));
    find_shares();
    place_bands();
    for (const SubjectBone& bone : b) {
      bone_distance.push_back(std::make_unique<geometry::MeshDistance>(bone.bone.mesh));
    }
    find_thumb_ball();
    band_volume = volumes(p.skin.vertices, core_point);
  }

  void place_links() {
    const SubjectJoints& joints = person->joints;
    const Vec3 wrist = person->skeleton.joint(hand::JointId::kWrist).centre;
    links.push_back({kThumbMetacarpalBody, joints.cmc.centre,
                     joints.phalanx[static_cast<int>(hand::Segment::kThumbProximal)].centre});
    for (int f = 0; f < hand::kFingerCount; ++f) {
      const auto segments = hand::segments_of(static_cast<hand::Finger>(f));
      const int count = f == 0 ? 2 : 3;
      const auto centre = [&](int k) -> Vec3 {
        return k < count ? joints.phalanx[index_of(*segments[k])].centre
                         : person->skeleton.fingertips[f];
      };
      for (int k = 0; k < count; ++k) {
        Vec3 to = centre(k + 1);
        if (k + 1 == count) to -= 6.0 * (to - centre(k)).normalized();
        links.push_back({static_cast<int>(*segments[k]), centre(k), to});
      }
      if (f > 0) {
        const Vec3 base = wrist + 0.3 * (centre(0) - wrist);
        links.push_back({0, base, centre(0)});
        links.push_back({0, wrist, base});
      }
    }
    double end = 0.0;
    for (const Vec3& v : person->skin.vertices) end = std::min(end, v.y());
    links.push_back({0, Vec3(wrist.x(), std::min(end + 4.0, wrist.y() - 1.0), wrist.z()), wrist});
  }

  void find_nearest() {
    const std::vector<Vec3>& skin = person->skin.vertices;
    for (const Vec3& v : skin) {
      Near best{std::numeric_limits<double>::max(), v};
      int body = 0;
      for (const Link& link : links) {
        const Near here = near_link(link, v);
        if (here.distance < best.distance) {
          best = here;
          body = link.body;
        }
      }
      nearest.push_back(body);
      depth.push_back(best.distance);
      core_point.push_back(best.point);
    }
  }

  void find_shares() {
    const geometry::TriangleMesh& skin = person->skin;
    const int n = skin.vertex_count();
    std::vector<Eigen::Triplet<double>> entries;
    for (const Triangle& t : skin.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
        const Vec3 p = skin.vertices[a] - skin.vertices[c], q = skin.vertices[b] - skin.vertices[c];
        const double cotangent =
            0.5 * std::clamp(p.dot(q) / std::max(p.cross(q).norm(), 1e-9), 0.02, 10.0);
        entries.emplace_back(a, b, -cotangent);
        entries.emplace_back(b, a, -cotangent);
        entries.emplace_back(a, a, cotangent);
        entries.emplace_back(b, b, cotangent);
      }
    }
    const std::vector<double> area = geometry::vertex_areas(skin);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, kBodyCount);
    for (int i = 0; i < n; ++i) {
      const double heat = area[i] / (depth[i] * depth[i]);
      entries.emplace_back(i, i, heat);
      right(i, nearest[i]) = heat;
    }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    if (solver.info() != Eigen::Success) {
      throw NumericalError("subject: the shares of the bones in the skin can't be found");
    }
    const Eigen::MatrixXd weight = solver.solve(right);
    share.resize(n);
    for (int i = 0; i < n; ++i) {
      double sum = 0.0;
      for (int b = 0; b < kBodyCount; ++b) sum += std::max(0.0, weight(i, b) - kLeastShare);
      for (int b = 0; b < kBodyCount; ++b) {
        const double w = weight(i, b) - kLeastShare;
        if (w > 0.0) share[i].push_back({b, w / sum});
      }
    }
  }

  static int chain_of(int body) {
    if (body == 0) return kPalmChain;
    if (body == kThumbMetacarpalBody) return 0;
    return static_cast<int>(*hand::finger_of(static_cast<hand::Segment>(body)));
  }

  // Bands: for every chain of bones the stations kBand apart along it, with linear hats, times the
  // chain's share in the vertex.
  void place_bands() {
    const std::vector<Vec3>& skin = person->skin.vertices;
    std::array<std::vector<Link>, kChains> chain;
    for (const Link& link : links) {
      if (link.body != 0) chain[chain_of(link.body)].push_back(link);
    }
    std::vector<std::array<double, kChains>> station(skin.size());
    std::array<double, kChains> low, high;
    low.fill(std::numeric_limits<double>::max());
    high.fill(-std::numeric_limits<double>::max());
    for (std::size_t i = 0; i < skin.size(); ++i) {
      for (int c = 0; c < hand::kFingerCount; ++c) {
        double along = 0.0, best = std::numeric_limits<double>::max();
        for (const Link& link : chain[c]) {
          const Near here = near_link(link, skin[i]);
          if (here.distance < best) {
            best = here.distance;
            station[i][c] = along + (here.point - link.from).norm();
          }
          along += (link.to - link.from).norm();
        }
      }
      station[i][kPalmChain] = skin[i].y();
      for (const Share& s : share[i]) {
        const int c = chain_of(s.body);
        low[c] = std::min(low[c], station[i][c]);
        high[c] = std::max(high[c], station[i][c]);
      }
    }
    std::array<int, kChains> first{}, bands{};
    int count = 0;
    for (int c = 0; c < kChains; ++c) {
      first[c] = count;
      bands[c] = std::max(2, 1 + static_cast<int>((high[c] - low[c]) / kBand));
      for (int k = count; k + 1 < count + bands[c]; ++k) neighbour_band.push_back({k, k + 1});
      count += bands[c];
    }
    band_volume.assign(count, 0.0);
    hat.resize(skin.size());
    for (std::size_t i = 0; i < skin.size(); ++i) {
      std::array<double, kChains> part{};
      for (const Share& s : share[i]) part[chain_of(s.body)] += s.weight;
      for (int c = 0; c < kChains; ++c) {
        if (part[c] <= 0.0) continue;
        const double x = (station[i][c] - low[c]) / (high[c] - low[c]) * (bands[c] - 1);
        const int k = std::clamp(static_cast<int>(x), 0, bands[c] - 2);
        const double t = std::clamp(x - k, 0.0, 1.0);
        if (t < 1.0) hat[i].push_back({first[c] + k, part[c] * (1.0 - t)});
        if (t > 0.0) hat[i].push_back({first[c] + k + 1, part[c] * t});
      }
    }
  }

  void find_thumb_ball() {
    const SubjectJoints& joints = person->joints;
    const RollingJoint& mp = joints.phalanx[static_cast<int>(hand::Segment::kThumbProximal)];
    const Vec3 palmar = mp.axis.cross(mp.along);
    const Vec3 middle = joints.cmc.centre + 0.45 * (mp.centre - joints.cmc.centre);
    const std::vector<Vec3>& skin = person->skin.vertices;
    size = person->skeleton.joint(hand::JointId::kMiddleMcp).centre.norm() / 92.5;
    const auto nearest_to = [&](const Vec3& p) {
      int best = 0;
      for (int i = 0; i < static_cast<int>(skin.size()); ++i) {
        if ((skin[i] - p).squaredNorm() < (skin[best] - p).squaredNorm()) best = i;
      }
      return best;
    };
    ball_vertex = nearest_to(middle + 18.0 * size * (palmar + Vec3::UnitZ()).normalized());
    ball = skin[ball_vertex];
    ball_radial = skin[static_cast<std::size_t>(
        nearest_to(middle + 18.0 * size * (palmar + 0.8 * Vec3::UnitX()).normalized()))];
    const Vec3 index = joints.phalanx[static_cast<int>(hand::Segment::kIndexProximal)].centre;
    web = skin[static_cast<std::size_t>(
        nearest_to(0.5 * (mp.centre + index) + 8.0 * size * Vec3::UnitZ()))];
    towards_wrist = -joints.cmc.along;
  }

  std::vector<double> volumes(const std::vector<Vec3>& skin, const std::vector<Vec3>& core) const {
    std::vector<double> volume(band_volume.size(), 0.0);
    for (const Triangle& t : person->skin.triangles) {
      const double v = prism_volume(skin, core, t) / 3.0;
      for (const int corner : t) {
        for (const Hat& h : hat[corner]) volume[h.band] += h.weight * v;
      }
    }
    return volume;
  }

  void blend(const std::array<geometry::Rigid3, kBodyCount>& motion, std::vector<Vec3>& skin,
             std::vector<Vec3>& core) const {
    std::array<DualQuaternion, kBodyCount> dual;
    for (std::size_t b = 0; b < dual.size(); ++b) dual[b] = dual_quaternion(motion[b]);
    skin = person->skin.vertices;
    core = core_point;
    for (std::size_t i = 0; i < skin.size(); ++i) {
      DualQuaternion sum;
      for (const Share& s : share[i]) {
        sum.real += s.weight * dual[s.body].real;
        sum.dual += s.weight * dual[s.body].dual;
      }
      const geometry::Rigid3 turn = rigid(sum);
      skin[i] = turn * skin[i];
      core[i] = turn * core[i];
    }
  }

  // Muscle that shortens swells: out along the skin's normal, and a little towards the wrist.
  void swell(const hand::Posture& posture, const geometry::Rigid3& metacarpal,
             std::vector<Vec3>& skin) const {
    constexpr double kFull = 22.0 * geometry::kDegree;
    const SaddleJoint& cmc = person->joints.cmc;
    const double f = (posture[hand::Dof::kThumbCmcFlexion] - cmc.flexion_reference) / kFull;
    const double a = (posture[hand::Dof::kThumbCmcAbduction] - cmc.abduction_reference) / kFull;
    const auto rising = [](double s) { return s > 0.0 ? std::pow(s, 1.25) : 0.0; };
    const std::vector<Vec3> normal = geometry::vertex_normals(skin, person->skin.triangles);
    const Vec3 slide = metacarpal.rotation * towards_wrist;
    for (std::size_t i = 0; i < skin.size(); ++i) {
      const Vec3& v = person->skin.vertices[i];
      const auto near = [&](const Vec3& place, double width) {
        const double w = width * size;
        return std::exp(-(v - place).squaredNorm() / (2.0 * w * w));
      };
      const double out =
          size * (7.6 * rising(f) * near(ball, 15.0) - 5.6 * rising(-f) * near(ball, 16.0) +
                  8.2 * rising(a) * near(ball_radial, 15.0) - 1.5 * rising(a) * near(web, 13.0) +
                  2.4 * rising(-a) * near(web, 14.0) + 5.6 * rising(-a) * near(ball, 15.0));
      const double along =
          size * (2.2 * rising(f) * near(ball, 15.0) - 1.6 * rising(-f) * near(ball, 15.0) +
                  1.6 * rising(a) * near(ball, 15.0) - 1.0 * rising(-a) * near(ball, 15.0));
      skin[i] += out * normal[i] + along * slide;
    }
  }

  void keep_volume(const std::vector<Vec3>& core, std::vector<Vec3>& skin) const {
    const auto bands = static_cast<Eigen::Index>(band_volume.size());
    constexpr double kMost = 2.5;  // mm in one round
    constexpr double kEven = 0.15;
    for (int round = 0; round < 4; ++round) {
      const std::vector<double> volume = volumes(skin, core);
      const geometry::TriangleMesh posed{skin, person->skin.triangles};
      const std::vector<double> area = geometry::vertex_areas(posed);
      const std::vector<Vec3> normal = geometry::vertex_normals(posed);
      // d volume_b / d offset_c; the offset of a vertex is its softness times its hats' offsets.
      Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(bands, bands);
      Eigen::VectorXd missing(bands);
      for (std::size_t i = 0; i < skin.size(); ++i) {
        for (const Hat& b : hat[i]) {
          for (const Hat& c : hat[i]) {
            matrix(b.band, c.band) += area[i] * softness(i) * b.weight * c.weight;
          }
        }
      }
      // Neighbouring bands move alike where the volume hardly shows.
      for (const auto& [b, c] : neighbour_band) {
        const double stiff = kEven * std::min(matrix(b, b), matrix(c, c));
        matrix(b, b) += stiff;
        matrix(c, c) += stiff;
        matrix(b, c) -= stiff;
        matrix(c, b) -= stiff;
      }
      for (Eigen::Index b = 0; b < bands; ++b) {
        missing[b] = band_volume[b] - volume[b];
        matrix(b, b) += 1e-3 * matrix(b, b) + 1e-6;
      }
      const Eigen::VectorXd offset = matrix.ldlt().solve(missing).cwiseMax(-kMost).cwiseMin(kMost);
      for (std::size_t i = 0; i < skin.size(); ++i) {
        double out = 0.0;
        for (const Hat& b : hat[i]) out += b.weight * offset[b.band];
        skin[i] += softness(i) * out * normal[i];
      }
    }
  }

  // Thick tissue gives way more than that over a knuckle; the thumb ball keeps its swelling.
  double softness(std::size_t i) const {
    const double width = 16.0 * size;
    const double on_ball =
        std::exp(-(person->skin.vertices[i] - ball).squaredNorm() / (2.0 * width * width));
    return std::clamp(depth[i] / 8.0, 0.4, 1.6) * (1.0 - 0.8 * on_ball);
  }

  // Skin that bends onto skin is pressed flat: both sides give way by half.
  void part_touching_skin(std::vector<Vec3>& skin) const {
    constexpr double kMost = 3.0;  // mm in one round
    for (int round = 0; round < 6; ++round) {
      const geometry::CrossingDepth crossing =
          geometry::crossing_depth({skin, person->skin.triangles});
      if (crossing.vertex.empty()) return;
      std::vector<double> in(skin.size(), 0.0);
      for (std::size_t k = 0; k < crossing.vertex.size(); ++k) {
        in[crossing.vertex[k]] = 0.5 * std::min(crossing.depth[k], kMost) + 0.1;
      }
      in = widened(std::move(in), 2);
      const std::vector<Vec3> normal = geometry::vertex_normals(skin, person->skin.triangles);
      for (std::size_t i = 0; i < skin.size(); ++i) skin[i] -= in[i] * normal[i];
    }
  }

  // What happens to a vertex draws its neighbours along.
  std::vector<double> widened(std::vector<double> height, int passes) const {
    for (int pass = 0; pass < passes; ++pass) {
      std::vector<double> wider = height;
      for (std::size_t i = 0; i < height.size(); ++i) {
        double mean = 0.0;
        for (const int j : neighbour[i]) mean += height[j];
        wider[i] = std::max(height[i], 0.8 * mean / static_cast<double>(neighbour[i].size()));
      }
      height = std::move(wider);
    }
    return height;
  }

  void lift_off_bones(const std::array<geometry::Rigid3, kBodyCount>& motion,
                      std::vector<Vec3>& skin) const {
    for (int round = 0; round < 3; ++round) {
      std::vector<double> lift(skin.size(), 0.0);
      parallel_for(static_cast<int>(skin.size()), [&](int i) {
        for (std::size_t b = 0; b < bones->size(); ++b) {
          const Vec3 p = motion[(*bones)[b].body].inverse() * skin[i];
          if (bone_distance[b]->bounding_box().exteriorDistance(p) > kLeastPosedCover) continue;
          geometry::DistanceSample sample;
          bone_distance[b]->sample({&p, 1}, 4.0, {&sample, 1});
          lift[i] = std::max(lift[i], kLeastPosedCover - sample.distance);
        }
      });
      bool is_free = true;
      for (const double l : lift) is_free = is_free && l < 0.01;
      if (is_free) return;
      lift = widened(std::move(lift), 3);
      const std::vector<Vec3> normal = geometry::vertex_normals(skin, person->skin.triangles);
      for (std::size_t i = 0; i < skin.size(); ++i) skin[i] += lift[i] * normal[i];
    }
  }
};

SoftTissue::SoftTissue(const SubjectPerson& person, const std::vector<SubjectBone>& bones)
    : impl_(std::make_unique<const Impl>(person, bones)) {}
SoftTissue::~SoftTissue() = default;

int SoftTissue::thumb_ball_vertex() const { return impl_->ball_vertex; }

double SoftTissue::finger_share(int vertex) const {
  double sum = 0.0;
  for (const Impl::Share& s : impl_->share[vertex]) {
    if (s.body != 0 && s.body != kThumbMetacarpalBody) sum += s.weight;
  }
  return sum;
}

PosedTissue SoftTissue::pose(const hand::Posture& posture) const {
  const std::array<geometry::Rigid3, kBodyCount> motion =
      body_motions(impl_->person->joints, posture);
  PosedTissue posed;
  impl_->blend(motion, posed.skin, posed.core);
  impl_->swell(posture, motion[kThumbMetacarpalBody], posed.skin);
  impl_->keep_volume(posed.core, posed.skin);
  impl_->part_touching_skin(posed.skin);
  impl_->lift_off_bones(motion, posed.skin);
  return posed;
}

}  // namespace palmar::phantom
