// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/capture/bone_names.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/geometry/mesh_measures.h"
#include "palmar/hand/posture_from_mesh.h"
#include "palmar/hand/skinning.h"
#include "palmar/hand/template_hand.h"

namespace palmar {
namespace {

constexpr double kLargestUnnamed = 5.0e3;  // mm^3
constexpr double kAlone = 16.0;            // 4 standard deviations
constexpr double kUnlikely = 9.0;          // 3 standard deviations
constexpr double kForbidden = 1e6;
constexpr double kSlender = 1.7;     // length over width
constexpr double kWidestGap = 10.0;  // mm
constexpr double kUsualShell = 0.3;  // share of the way from dark to marrow
constexpr double kDarkEnough = 0.6;
constexpr double kBorder = 4.0;     // mm
constexpr double kNearby = 20.0;    // mm
constexpr double kStraight = 1.15;  // widening that two parts in a row may show
constexpr double kShell = 0.8;      // mm of cortical bone round marrow

std::size_t at(int i) { return static_cast<std::size_t>(i); }

double square(double x) { return x * x; }

/// Only shafts come in two parts.
bool is_long(const BoneOutline& bone) { return bone.length > kSlender * bone.width; }

/// `may_be_cut`: the expected bone reaches out of the image.
double pair_cost(const BoneOutline& found, const BoneOutline& expected, bool is_cut,
                 bool may_be_cut) {
  double place = (found.centre - expected.centre).norm();
  if (is_cut && may_be_cut) {
    // How much is seen of it shifts its centre; the end that is seen stays.
    place = std::numeric_limits<double>::infinity();
    for (const Vec3& end : found.ends) {
      for (const Vec3& other : expected.ends) place = std::min(place, (end - other).norm());
    }
  }
  double cost = square(place / 5.0);
  if (is_long(expected) && is_long(found)) {
    const double angle = std::acos(std::clamp(std::abs(found.axis.dot(expected.axis)), 0.0, 1.0));
    cost += square(angle / 0.35);
  }
  const auto differ = [](double a, double b) {
    return square(std::log(std::max(a, 1.0) / std::max(b, 1.0)) / 0.3);
  };
  if (!is_cut) cost += differ(found.length, expected.length);
  cost += differ(found.width, expected.width);
  if (is_cut && !may_be_cut) cost += kUnlikely;
  return cost;
}

/// Bones of the model next to each other in a finger: pairs of indices, proximal first.
std::vector<std::array<int, 2>> chain_links(const Hand& model) {
  std::vector<std::array<int, 2>> links;
  for (int b = 0; b + 1 < static_cast<int>(model.bones.size()); ++b) {
    const std::string& name = model.bones[at(b)].name;
    const std::string& next = model.bones[at(b) + 1].name;
    // Bones of a finger stand in a row, from the metacarpal outwards.
    if (name.substr(0, name.find('_')) == next.substr(0, next.find('_')) &&
        next.ends_with("_phalanx")) {
      links.push_back({b, b + 1});
    }
  }
  return links;
}

struct Pairing {
  std::vector<MarrowRegion> candidates;  ///< those given, then joined ones
  std::vector<char> is_used;             ///< of those given: wholly or in part
  std::vector<int> found;                ///< per bone of the model
  std::vector<BoneOutline> expected;     ///< the same
  double cost = 0.0;                     ///< mean over the model's bones
};

/// Darkest signal round a region: 0 cortical bone, 1 the region's own.
double shell_of(const MarrowRegion& region, const ScanLevels& levels) {
  return (region.shell - levels.dark) / std::max(1e-9, region.level - levels.dark);
}

/// Whether two regions may be parts of one bone: as bright, and both darkly enclosed.
bool is_alike(const MarrowRegion& a, const MarrowRegion& b, const ScanLevels& levels) {
  return std::abs(a.level - b.level) < 0.15 * (levels.bright - levels.dark) &&
         std::abs(shell_of(a, levels) - shell_of(b, levels)) < 0.15 &&
         shell_of(b, levels) < kDarkEnough;
}

/// What may be paired with a bone of the model: a region, or two in a row.
struct Hypotheses {
  std::vector<MarrowRegion> regions;
  std::vector<BoneOutline> outlines;
  void add(MarrowRegion region) {
    outlines.push_back(outline_of(region));
    regions.push_back(std::move(region));
  }
};

/// Whether two parts make one long bone: the one's end is where the other begins.
bool is_in_a_row(const BoneOutline& both, const BoneOutline& a, const BoneOutline& b) {
  return both.width < kStraight * std::max(a.width, b.width) && is_long(both) &&
         both.length > 0.8 * (a.length + b.length);
}

/// A shaft whose marrow is too thin to be seen leaves two ends in a row.
Hypotheses hypotheses_of(const std::vector<MarrowRegion>& candidates, const ScanLevels& levels,
                         double longest) {
  Hypotheses all;
  for (const MarrowRegion& candidate : candidates) all.add(candidate);
  const int count = static_cast<int>(candidates.size());
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) {
      const BoneOutline &first = all.outlines[at(a)], &second = all.outlines[at(b)];
      const MarrowRegion &m = candidates[at(a)], &n = candidates[at(b)];
      if (overlap(m, n) || !is_alike(m, n, levels) || !is_alike(n, m, levels)) continue;
      const double apart = (first.centre - second.centre).norm();
      if (apart > longest || apart > 0.5 * (first.length + second.length) + kWidestGap) continue;
      if (gap_between(m, n) > kWidestGap) continue;
      MarrowRegion both = joined(m, n);
      const BoneOutline outline = outline_of(both);
      if (!is_in_a_row(outline, first, second) || outline.length > longest) continue;
      all.add(std::move(both));
    }
  }
  return all;
}

/// Least-cost pairs that use no region twice: where two do, the one or the other is forbidden,
/// whichever costs less.
std::vector<int> exclusive_pairs(std::vector<std::vector<double>> cost, const Hypotheses& all) {
  const auto total = [&](const std::vector<int>& pairs) {
    double sum = 0.0;
    for (std::size_t e = 0; e < pairs.size(); ++e) {
      sum += pairs[e] < 0 ? kAlone : cost[e][at(pairs[e])];
    }
    return sum;
  };
  std::vector<int> pairs = least_cost_pairs(cost, kAlone);
  while (true) {
    int a = -1, b = -1;
    for (std::size_t e = 0; e < pairs.size() && a < 0; ++e) {
      for (std::size_t f = e + 1; f < pairs.size() && a < 0; ++f) {
        if (pairs[e] < 0 || pairs[f] < 0) continue;
        if (!overlap(all.regions[at(pairs[e])], all.regions[at(pairs[f])])) continue;
        a = pairs[e];
        b = pairs[f];
      }
    }
    if (a < 0) return pairs;
    const auto without = [&](int column) {
      std::vector<std::vector<double>> fewer = cost;
      for (std::vector<double>& row : fewer) row[at(column)] = kForbidden;
      return fewer;
    };
    const std::vector<int> first = least_cost_pairs(without(a), kAlone),
                           second = least_cost_pairs(without(b), kAlone);
    const bool keeps_b = total(first) <= total(second);
    cost = without(keeps_b ? a : b);
    pairs = keeps_b ? first : second;
  }
}

std::vector<BoneOutline> expected_bones(const TriangleMesh& skin, const Hand& model,
                                        const Progress& progress) {
  const MeshFit fit = fit_posture_to_mesh(model, skin, {.fits_scale = true}, progress);
  std::vector<BoneOutline> expected;
  for (const TriangleMesh& mesh : pose_bones(model, fit.posture)) {
    BoneOutline outline = outline_of(mesh);
    outline.centre = fit.mesh_from_hand * (fit.scale * outline.centre);
    outline.axis = fit.mesh_from_hand.rotation * outline.axis;
    for (Vec3& end : outline.ends) end = fit.mesh_from_hand * (fit.scale * end);
    outline.length *= fit.scale;
    outline.width *= fit.scale;
    expected.push_back(outline);
  }
  return expected;
}

Pairing pair_bones(const std::vector<MarrowRegion>& candidates, const ScanLevels& levels,
                   const TriangleMesh& skin, const Hand& model, const Progress& progress) {
  Pairing pairing;
  pairing.expected = expected_bones(skin, model, progress);
  const std::vector<BoneOutline>& expected = pairing.expected;
  double longest = 0.0;
  for (const BoneOutline& outline : expected) longest = std::max(longest, outline.length);
  Hypotheses all = hypotheses_of(candidates, levels, 1.3 * longest);
  const Box3 seen = bounding_box(skin);
  const std::vector<std::array<int, 2>> links = chain_links(model);
  std::vector<Vec3> shift(expected.size(), Vec3::Zero());
  const auto cost_of = [&](std::size_t e, const BoneOutline& outline, bool is_cut) {
    BoneOutline moved = expected[e];
    moved.centre += shift[e];
    for (Vec3& end : moved.ends) end += shift[e];
    // The model's forearm may be shorter than what is seen.
    bool may_be_cut = model.bones[e].name == "radius" || model.bones[e].name == "ulna";
    for (const Vec3& end : moved.ends) {
      may_be_cut = may_be_cut || (end - seen.min()).minCoeff() < kBorder ||
                   (seen.max() - end).minCoeff() < kBorder;
    }
    return pair_cost(outline, moved, is_cut, may_be_cut);
  };
  std::vector<std::vector<double>> cost;
  for (int round = 0; round < 6; ++round) {
    cost.assign(expected.size(), std::vector<double>(all.outlines.size(), 0.0));
    for (std::size_t e = 0; e < expected.size(); ++e) {
      for (std::size_t f = 0; f < all.outlines.size(); ++f) {
        cost[e][f] = cost_of(e, all.outlines[f], all.regions[f].is_cut) +
                     square(shell_of(all.regions[f], levels) / kUsualShell);
        if (f >= candidates.size() && !is_long(expected[e])) cost[e][f] = kForbidden;
      }
    }
    pairing.found = exclusive_pairs(cost, all);
    // What a bone is off by tells the same of itself and, by half, of its neighbours.
    std::vector<Vec3> sum(expected.size(), Vec3::Zero());
    std::vector<double> weight(expected.size(), 0.5);
    const auto add = [&](int to, int from, double w) {
      const int f = pairing.found[at(from)];
      // Of one that is cut only a part is seen.
      if (f < 0 || all.regions[at(f)].is_cut) return;
      sum[at(to)] += w * (all.outlines[at(f)].centre - expected[at(from)].centre);
      weight[at(to)] += w;
    };
    for (int e = 0; e < static_cast<int>(expected.size()); ++e) {
      add(e, e, 0.5);
      for (int f = 0; f < static_cast<int>(expected.size()); ++f) {
        const double away = (expected[at(e)].centre - expected[at(f)].centre).norm() / kNearby;
        if (f != e && away < 2.0) add(e, f, 0.25 * std::exp(-away * away));
      }
    }
    for (const auto& [a, b] : links) {
      add(a, b, 0.5);
      add(b, a, 0.5);
    }
    for (std::size_t e = 0; e < expected.size(); ++e) shift[e] = sum[e] / weight[e];
  }

  // Parts that nobody wants may belong to a neighbour: the best one first.
  std::vector<char> is_taken(candidates.size(), 0);
  const auto take = [&](const MarrowRegion& region) {
    for (std::size_t g = 0; g < candidates.size(); ++g) {
      if (overlap(region, candidates[g])) is_taken[g] = 1;
    }
  };
  for (const int f : pairing.found) {
    if (f >= 0) take(all.regions[at(f)]);
  }
  for (int round = 0; round < 3; ++round) {
    for (std::size_t e = 0; e < expected.size(); ++e) {
      const int f = pairing.found[e];
      if (f < 0 || !is_long(expected[e])) continue;
      double least = cost_of(e, all.outlines[at(f)], all.regions[at(f)].is_cut) - 1.0;
      int best = -1;
      for (std::size_t g = 0; g < candidates.size(); ++g) {
        const MarrowRegion &own = all.regions[at(f)], &part = candidates[g];
        if (is_taken[g] != 0 || !is_alike(own, part, levels)) continue;
        if ((all.outlines[g].centre - all.outlines[at(f)].centre).norm() > expected[e].length) {
          continue;
        }
        if (gap_between(own, part) > kWidestGap) continue;
        const MarrowRegion both = joined(own, part);
        const BoneOutline outline = outline_of(both);
        if (!is_in_a_row(outline, all.outlines[at(f)], all.outlines[g])) continue;
        const double then = cost_of(e, outline, both.is_cut);
        if (then > least) continue;
        least = then;
        best = static_cast<int>(g);
      }
      if (best < 0) continue;
      take(candidates[at(best)]);
      all.regions[at(f)] = joined(all.regions[at(f)], candidates[at(best)]);
      all.outlines[at(f)] = outline_of(all.regions[at(f)]);
    }
  }
  for (std::size_t e = 0; e < expected.size(); ++e) {
    const int f = pairing.found[e];
    pairing.cost += f < 0 ? kAlone : cost[e][at(f)];
  }
  pairing.cost /= static_cast<double>(std::max<std::size_t>(1, expected.size()));
  pairing.candidates = std::move(all.regions);
  pairing.is_used = std::move(is_taken);
  return pairing;
}

BoneOutline outline_along(const std::vector<Vec3>& points, const Vec3& centre,
                          const Eigen::Matrix3d& spread) {
  BoneOutline outline;
  outline.centre = centre;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  std::array<double, 3> extents{};
  for (int a = 0; a < 3; ++a) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& p : points) {
      const double d = axes.eigenvectors().col(a).dot(p);
      low = std::min(low, d);
      high = std::max(high, d);
    }
    extents[at(a)] = high - low;
    if (a == 2) {
      const Vec3 axis = axes.eigenvectors().col(a);
      outline.ends = {centre + (low - axis.dot(centre)) * axis,
                      centre + (high - axis.dot(centre)) * axis};
    }
  }
  outline.axis = axes.eigenvectors().col(2);
  outline.length = extents[2];
  outline.width = 0.5 * (extents[0] + extents[1]);
  return outline;
}

}  // namespace

BoneOutline outline_of(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return {};
  const Vec3 centre = centre_of_volume(mesh);
  const std::vector<double> area = vertex_areas(mesh);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 d = mesh.vertices[v] - centre;
    spread += area[v] * d * d.transpose();
  }
  return outline_along(mesh.vertices, centre, spread);
}

BoneOutline outline_of(const MarrowRegion& marrow) {
  if (marrow.voxels.empty()) return {};
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : marrow.voxels) centre += p;
  centre /= static_cast<double>(marrow.voxels.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : marrow.voxels) spread += (p - centre) * (p - centre).transpose();
  BoneOutline outline = outline_along(marrow.voxels, centre, spread);
  outline.length += 2.0 * kShell;
  outline.width += 2.0 * kShell;
  return outline;
}

std::vector<int> least_cost_pairs(const std::vector<std::vector<double>>& cost, double alone) {
  const int rows = static_cast<int>(cost.size());
  const int real = rows > 0 ? static_cast<int>(cost.front().size()) : 0;
  const int columns = real + rows;  // one more column per row, to stay alone in
  const auto cost_at = [&](int row, int column) {
    if (column < real) return std::min(cost[at(row)][at(column)], 1e6);
    return column - real == row ? alone : 1e6;
  };
  // Shortest augmenting paths with potentials, row by row (1-based; column 0 is the start).
  std::vector<double> u(at(rows) + 1, 0.0), v(at(columns) + 1, 0.0);
  std::vector<int> row_of(at(columns) + 1, 0), before(at(columns) + 1, 0);
  for (int row = 1; row <= rows; ++row) {
    row_of[0] = row;
    int column = 0;
    std::vector<double> least(at(columns) + 1, std::numeric_limits<double>::infinity());
    std::vector<char> is_used(at(columns) + 1, 0);
    do {
      is_used[at(column)] = 1;
      const int from = row_of[at(column)];
      double delta = std::numeric_limits<double>::infinity();
      int next = 0;
      for (int c = 1; c <= columns; ++c) {
        if (is_used[at(c)] != 0) continue;
        const double reduced = cost_at(from - 1, c - 1) - u[at(from)] - v[at(c)];
        if (reduced < least[at(c)]) {
          least[at(c)] = reduced;
          before[at(c)] = column;
        }
        if (least[at(c)] < delta) {
          delta = least[at(c)];
          next = c;
        }
      }
      for (int c = 0; c <= columns; ++c) {
        if (is_used[at(c)] != 0) {
          u[at(row_of[at(c)])] += delta;
          v[at(c)] -= delta;
        } else {
          least[at(c)] -= delta;
        }
      }
      column = next;
    } while (row_of[at(column)] != 0);
    do {
      const int previous = before[at(column)];
      row_of[at(column)] = row_of[at(previous)];
      column = previous;
    } while (column != 0);
  }
  std::vector<int> pair(at(rows), -1);
  for (int c = 1; c <= real; ++c) {
    const int row = row_of[at(c)];
    if (row > 0 && cost_at(row - 1, c - 1) < alone) pair[at(row - 1)] = c - 1;
  }
  return pair;
}

BoneNames name_bones(std::vector<MarrowRegion> candidates, const ScanLevels& levels,
                     const TriangleMesh& skin, const Hand& model, const KnownSide& known,
                     const Progress& progress) {
  const Hand other = mirrored(model);
  Pairing own = pair_bones(candidates, levels, skin, model, progress);
  Pairing opposite = pair_bones(candidates, levels, skin, other, progress);
  bool is_own = own.cost <= opposite.cost;
  if (known.side) {
    const bool says_own = *known.side == model.side;
    const double said = says_own ? own.cost : opposite.cost;
    const bool is_doubted = (says_own ? opposite.cost : own.cost) < known.doubted_below * said;
    is_own = says_own != is_doubted;
  }
  Pairing& best = is_own ? own : opposite;

  BoneNames names;
  names.side = is_own ? model.side : other.side;
  names.misfit = best.cost;
  names.other_misfit = is_own ? opposite.cost : own.cost;
  std::vector<std::string> missing;
  double level = 0.0;
  for (std::size_t e = 0; e < best.found.size(); ++e) {
    const int f = best.found[e];
    if (f >= 0) {
      const BoneOutline outline = outline_of(best.candidates[at(f)]);
      names.bones.push_back(best.candidates[at(f)]);
      names.bones.back().is_leaky = outline.length > 1.25 * best.expected[e].length ||
                                    outline.width > 1.4 * best.expected[e].width;
      level += best.candidates[at(f)].level;
      names.name.push_back(model.bones[e].name);
    } else {
      missing.push_back(model.bones[e].name);
    }
  }
  level /= static_cast<double>(std::max<std::size_t>(1, names.bones.size()));
  for (std::size_t f = 0; f < best.is_used.size(); ++f) {
    const MarrowRegion& left = best.candidates[f];
    if (best.is_used[f] != 0 || left.volume < 150.0) continue;
    if (left.shell > levels.dark + 0.3 * (left.level - levels.dark)) continue;
    if (left.level < 0.9 * level || left.volume > kLargestUnnamed) continue;
    names.bones.push_back(left);
    names.name.emplace_back();
  }
  if (!missing.empty()) {
    std::string list;
    for (const std::string& name : missing) list += (list.empty() ? "" : ", ") + name;
    names.notes.push_back(
        fmt::format("{} of {} bones not found: {}", missing.size(), model.bones.size(), list));
  }
  if (!known.side && names.other_misfit < 1.5 * names.misfit) {
    names.notes.push_back(fmt::format(
        "the bones fit a {} hand little better than the other one ({:.1f} against {:.1f}): check "
        "the side",
        name_of(names.side), names.misfit, names.other_misfit));
  }
  return names;
}

}  // namespace palmar
