// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_pairing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "palmar/core/least_cost_pairs.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::capture {
namespace {

constexpr double kAlone = 16.0;      // of a bone that isn't found: 4 standard deviations
constexpr double kUnlikely = 9.0;    // 3 standard deviations
constexpr double kUnseen = 4.0;      // of a forearm's bone: images often end before it
constexpr double kLikeMarrow = 4.5;  // what parts of a bone may cost
constexpr double kForbidden = 1e6;
constexpr double kSlender = 1.7;     // length over width
constexpr double kWidestGap = 15.0;  // mm
constexpr double kLeastConvexity = 0.85;
constexpr double kMostOpen = 0.05;
constexpr double kUsualShell = 0.3;  // share of the way from dark to marrow
constexpr double kDarkEnough = 0.6;
constexpr double kBorder = 4.0;     // mm
constexpr double kNearby = 20.0;    // mm
constexpr double kStraight = 1.15;  // widening that two parts in a row may show
// Soft tissue beyond the last phalanx, mm: 3.7 to 5.7 in the mean (Buryanov, Kotiuk 2010).
constexpr double kTipTissue = 4.6, kTipDeviation = 2.5;
constexpr double kUsualGap = 4.0, kNarrower = 1.5, kWider = 2.5;  // between two bones' marrow, mm
constexpr int kChoices = 10;                                      // of a bone in a finger

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
std::vector<std::array<int, 2>> chain_links(const hand::Hand& model) {
  std::vector<std::array<int, 2>> links;
  for (int b = 0; b + 1 < static_cast<int>(model.bones.size()); ++b) {
    const std::string& name = model.bones[b].name;
    const std::string& next = model.bones[b + 1].name;
    // Bones of a finger stand in a row, from the metacarpal outwards.
    if (name.substr(0, name.find('_')) == next.substr(0, next.find('_')) &&
        next.ends_with("_phalanx")) {
      links.push_back({b, b + 1});
    }
  }
  return links;
}

/// Darkest signal round a region: 0 cortical bone, 1 the region's own.
double shell_of(const MarrowRegion& region, const ScanLevels& levels) {
  return (region.shell - levels.dark) / std::max(1e-9, region.level - levels.dark);
}

/// What speaks against marrow: no dark shell, or one that is open; bent round something as fat is.
double marrow_cost(const MarrowRegion& region, const ScanLevels& levels) {
  return square(shell_of(region, levels) / kUsualShell) +
         std::min(kUnlikely, square(std::max(0.0, region.open - kMostOpen) / kMostOpen)) +
         std::min(kUnlikely, square(std::max(0.0, kLeastConvexity - region.convexity) / 0.08));
}

/// Whether two regions may be parts of one bone: as bright, and both darkly enclosed.
bool is_alike(const MarrowRegion& a, const MarrowRegion& b, const ScanLevels& levels) {
  return std::abs(a.level - b.level) < 0.15 * (levels.bright - levels.dark) &&
         std::abs(shell_of(a, levels) - shell_of(b, levels)) < 0.25 &&
         shell_of(b, levels) < kDarkEnough;
}

/// Whether two parts make one long bone: the one's end is where the other begins.
bool is_in_a_row(const BoneOutline& both, const BoneOutline& a, const BoneOutline& b) {
  return both.width < kStraight * std::max(a.width, b.width) && is_long(both) &&
         both.length - 2.0 * kCorticalShell > 0.75 * (a.length + b.length - 4.0 * kCorticalShell);
}

/// From where a bone's marrow ends, along it, to the skin: what lies beyond the last phalanx of a
/// finger that points to `ahead`, mm. Not so if it's only the near part of it, or of the bone
/// before.
double beyond_tip(const BoneOutline& found, const Vec3& ahead, const geometry::RayQuery& skin) {
  Vec3 way = ahead;
  if (is_long(found)) way = found.axis.dot(ahead) < 0.0 ? Vec3(-found.axis) : found.axis;
  const double far =
      std::max(way.dot(found.ends[0] - found.centre), way.dot(found.ends[1] - found.centre));
  const std::optional<geometry::RayHit> hit = skin.first_hit(found.centre, way);
  return hit ? hit->distance - far - kCorticalShell : std::numeric_limits<double>::infinity();
}

/// What the marrow of two bones next to each other in a finger keeps apart: two shells and a joint
/// space. Parts of one shaft come nearer, and something lies between bones far apart.
double link_cost(const MarrowRegion& a, const MarrowRegion& b) {
  const double gap = gap_between(a, b) - kUsualGap;
  return square(gap / (gap < 0.0 ? kNarrower : kWider));
}

/// link_cost() of hypotheses, each pair worked out once.
class LinkCosts {
 public:
  double operator()(const BoneHypotheses& all, int a, int b) {
    const auto [at_pair, is_new] = known_.try_emplace(std::minmax(a, b), 0.0);
    if (is_new) at_pair->second = link_cost(all.regions[a], all.regions[b]);
    return at_pair->second;
  }

 private:
  std::map<std::pair<int, int>, double> known_;
};

/// Least-cost pairs that use no region twice: where two do, the one or the other is forbidden,
/// whichever costs less.
std::vector<int> exclusive_pairs(std::vector<std::vector<double>> cost,
                                 const std::vector<const MarrowRegion*>& regions) {
  const auto total = [&](const std::vector<int>& pairs) {
    double sum = 0.0;
    for (std::size_t e = 0; e < pairs.size(); ++e) {
      sum += pairs[e] < 0 ? kAlone : cost[e][pairs[e]];
    }
    return sum;
  };
  std::vector<int> pairs = least_cost_pairs(cost, kAlone);
  while (true) {
    int a = -1, b = -1;
    for (std::size_t e = 0; e < pairs.size() && a < 0; ++e) {
      for (std::size_t f = e + 1; f < pairs.size() && a < 0; ++f) {
        if (pairs[e] < 0 || pairs[f] < 0) continue;
        if (!overlap(*regions[pairs[e]], *regions[pairs[f]])) continue;
        a = pairs[e];
        b = pairs[f];
      }
    }
    if (a < 0) return pairs;
    const auto without = [&](int column) {
      std::vector<std::vector<double>> fewer = cost;
      for (std::vector<double>& row : fewer) row[column] = kForbidden;
      return fewer;
    };
    const std::vector<int> first = least_cost_pairs(without(a), kAlone),
                           second = least_cost_pairs(without(b), kAlone);
    const bool keeps_b = total(first) <= total(second);
    cost = without(keeps_b ? a : b);
    pairs = keeps_b ? first : second;
  }
}

/// Chooses again along each finger, where bones follow each other: the cheapest chain of the bones'
/// own costs and link_cost(), each bone one of its cheapest hypotheses or none (Viterbi 1967).
/// Regions that other bones hold are left to them.
void choose_along(const std::vector<std::vector<int>>& rays,
                  const std::vector<std::vector<double>>& cost, const BoneHypotheses& all,
                  LinkCosts& links, std::vector<int>& found) {
  for (const std::vector<int>& ray : rays) {
    const auto is_free = [&](const MarrowRegion& region) {
      for (std::size_t e = 0; e < found.size(); ++e) {
        if (found[e] < 0 || std::find(ray.begin(), ray.end(), static_cast<int>(e)) != ray.end()) {
          continue;
        }
        if (overlap(region, all.regions[found[e]])) return false;
      }
      return true;
    };
    struct Choice {
      int hypothesis = -1, before = -1;
      double total = 0.0;
    };
    std::vector<std::vector<Choice>> steps;
    for (const int e : ray) {
      std::vector<int> best;
      for (std::size_t f = 0; f < all.regions.size(); ++f) {
        if (cost[e][f] < kAlone) best.push_back(static_cast<int>(f));
      }
      std::sort(best.begin(), best.end(),
                [&](int f, int g) { return std::pair(cost[e][f], f) < std::pair(cost[e][g], g); });
      std::vector<Choice> step{{-1, -1, kAlone}};
      for (const int f : best) {
        if (static_cast<int>(step.size()) > kChoices) break;
        if (is_free(all.regions[f])) step.push_back({f, -1, cost[e][f]});
      }
      if (!steps.empty()) {
        for (Choice& choice : step) {
          double least = std::numeric_limits<double>::infinity();
          for (std::size_t p = 0; p < steps.back().size(); ++p) {
            const Choice& previous = steps.back()[p];
            double total = previous.total;
            if (choice.hypothesis >= 0 && previous.hypothesis >= 0) {
              const MarrowRegion &a = all.regions[previous.hypothesis],
                                 &b = all.regions[choice.hypothesis];
              if (overlap(a, b)) continue;
              total += links(all, previous.hypothesis, choice.hypothesis);
            }
            if (total >= least) continue;
            least = total;
            choice.before = static_cast<int>(p);
          }
          choice.total += least;
        }
      }
      steps.push_back(std::move(step));
    }
    int last = 0;
    for (std::size_t k = 0; k < steps.back().size(); ++k) {
      if (steps.back()[k].total < steps.back()[last].total) last = static_cast<int>(k);
    }
    for (std::size_t k = steps.size(); k-- > 0;) {
      found[ray[k]] = steps[k][last].hypothesis;
      last = steps[k][last].before;
    }
  }
}

/// Costs of hypotheses for bones that are expected somewhere, and what they are recognised by.
class Pairer {
 public:
  Pairer(BoneHypotheses hypotheses, const ScanLevels& levels, const geometry::TriangleMesh& skin,
         const hand::Hand& model, std::vector<BoneOutline> expected)
      : all_(std::move(hypotheses)),
        levels_(levels),
        skin_(skin),
        seen_(geometry::bounding_box(skin)),
        expected_(std::move(expected)),
        count_(static_cast<int>(expected_.size())),
        links_(chain_links(model)),
        beside_(expected_.size()),
        shift_(expected_.size(), Vec3::Zero()),
        ahead_(expected_.size(), Vec3::Zero()),
        may_be_split_(expected_.size()),
        is_forearm_(expected_.size()) {
    for (const auto& [a, b] : links_) {
      if (rays_.empty() || rays_.back().back() != a) rays_.push_back({a});
      rays_.back().push_back(b);
      beside_[a].push_back(b);
      beside_[b].push_back(a);
      if (model.bones[b].name.ends_with("_distal_phalanx")) {
        ahead_[b] = (expected_[b].centre - expected_[a].centre).normalized();
      }
    }
    for (std::size_t e = 0; e < expected_.size(); ++e) {
      const std::string& name = model.bones[e].name;
      may_be_split_[e] = is_long(expected_[e]) || name.ends_with("_phalanx") ? 1 : 0;
      is_forearm_[e] = name == "radius" || name == "ulna" ? 1 : 0;
    }
  }

  /// What pairs and neighbours cost, over the model's bones.
  double pair() {
    for (int round = 0; round < 6; ++round) {
      pair_once();
      shift_expected();
    }
    double sum = 0.0;
    for (int e = 0; e < count_; ++e) {
      const int f = found_[e];
      sum += f >= 0 ? cost_[e][f] : (is_forearm_[e] != 0 ? kUnseen : kAlone);
    }
    for (const auto& [a, b] : links_) {
      if (found_[a] < 0 || found_[b] < 0) continue;
      sum += link_costs_(all_, found_[a], found_[b]);
    }
    return sum / std::max(1, count_);
  }

  /// After pair(): joins what is left over and gives everything away.
  BonePairing finish() {
    mark_used();
    take_loose_parts();
    BonePairing pairing;
    pairing.regions = std::move(all_.regions);
    pairing.is_used = std::move(is_used_);
    pairing.found = std::move(found_);
    pairing.expected = std::move(expected_);
    return pairing;
  }

 private:
  double cost_of(std::size_t e, const BoneOutline& outline, bool is_cut) const {
    BoneOutline moved = expected_[e];
    moved.centre += shift_[e];
    for (Vec3& end : moved.ends) end += shift_[e];
    // The model's forearm may be shorter than what is seen.
    bool may_be_cut = is_forearm_[e] != 0;
    for (const Vec3& end : moved.ends) {
      may_be_cut = may_be_cut || (end - seen_.min()).minCoeff() < kBorder ||
                   (seen_.max() - end).minCoeff() < kBorder;
    }
    double cost = pair_cost(outline, moved, is_cut, may_be_cut);
    if (!ahead_[e].isZero() && cost < kAlone && !(is_cut && may_be_cut)) {
      cost += square((beyond_tip(outline, ahead_[e], skin_) - kTipTissue) / kTipDeviation);
    }
    return cost;
  }

  void pair_once() {
    const int count = static_cast<int>(all_.outlines.size());
    cost_.assign(expected_.size(), std::vector<double>(count, kForbidden));
    std::vector<int> wanted;  // hypotheses that some bone may be
    for (int f = 0; f < count; ++f) {
      double least = kForbidden;
      for (std::size_t e = 0; e < expected_.size(); ++e) {
        if (f >= all_.single && may_be_split_[e] == 0) continue;
        cost_[e][f] = all_.cost[f] + cost_of(e, all_.outlines[f], all_.regions[f].is_cut);
        least = std::min(least, cost_[e][f]);
      }
      if (least < kAlone) wanted.push_back(f);
    }
    std::vector<std::vector<double>> cost(expected_.size());
    std::vector<const MarrowRegion*> regions;
    for (const int f : wanted) {
      regions.push_back(&all_.regions[f]);
      for (std::size_t e = 0; e < expected_.size(); ++e) cost[e].push_back(cost_[e][f]);
    }
    found_ = exclusive_pairs(std::move(cost), regions);
    for (int& f : found_) f = f < 0 ? -1 : wanted[f];
    choose_along(rays_, cost_, all_, link_costs_, found_);
  }

  /// What a bone is off by shows the same of itself and, by half, of its neighbours.
  void shift_expected() {
    std::vector<Vec3> sum(expected_.size(), Vec3::Zero());
    std::vector<double> weight(expected_.size(), 0.5);
    const auto add = [&](int to, int from, double w) {
      const int f = found_[from];
      // Of one that is cut only a part is seen.
      if (f < 0 || all_.regions[f].is_cut) return;
      sum[to] += w * (all_.outlines[f].centre - expected_[from].centre);
      weight[to] += w;
    };
    for (int e = 0; e < count_; ++e) {
      add(e, e, 0.5);
      for (int f = 0; f < count_; ++f) {
        const double away = (expected_[e].centre - expected_[f].centre).norm() / kNearby;
        if (f != e && away < 2.0) add(e, f, 0.25 * std::exp(-away * away));
      }
    }
    for (const auto& [a, b] : links_) {
      add(a, b, 0.5);
      add(b, a, 0.5);
    }
    for (std::size_t e = 0; e < expected_.size(); ++e) shift_[e] = sum[e] / weight[e];
  }

  void take(const MarrowRegion& region) {
    for (int g = 0; g < all_.single; ++g) {
      if (overlap(region, all_.regions[g])) is_used_[g] = 1;
    }
  }

  void mark_used() {
    is_used_.assign(all_.single, 0);
    for (const int f : found_) {
      if (f >= 0) take(all_.regions[f]);
    }
  }

  /// Cost of a bone with those next to it in the finger.
  double in_place(std::size_t e, const BoneOutline& outline, const MarrowRegion& region) const {
    double sum = cost_of(e, outline, region.is_cut);
    for (const int other : beside_[e]) {
      const int g = found_[other];
      if (g >= 0) sum += link_cost(region, all_.regions[g]);
    }
    return sum;
  }

  /// Parts that nobody wants may belong to a neighbour: the best one first.
  void take_loose_parts() {
    for (int round = 0; round < 3; ++round) {
      for (std::size_t e = 0; e < expected_.size(); ++e) {
        const int f = found_[e];
        if (f < 0 || may_be_split_[e] == 0) continue;
        const int part = best_part(e, f);
        if (part < 0) continue;
        const MarrowRegion both = joined(all_.regions[f], all_.regions[part]);
        take(both);
        // A hypothesis of its own: what was joined stays what it was.
        found_[e] = static_cast<int>(all_.regions.size());
        for (auto& row : cost_) row.push_back(row[f]);
        all_.outlines.push_back(outline_of(both));
        all_.regions.push_back(both);
      }
    }
  }

  int best_part(std::size_t e, int f) const {
    const BoneOutline& outline = all_.outlines[f];
    const MarrowRegion& own = all_.regions[f];
    double least = in_place(e, outline, own) - 1.0;
    int best = -1;
    for (int g = 0; g < all_.single; ++g) {
      const MarrowRegion& part = all_.regions[g];
      if (is_used_[g] != 0 || !is_alike(own, part, levels_)) continue;
      if ((all_.outlines[g].centre - outline.centre).norm() > expected_[e].length) continue;
      if (gap_between(own, part) > kWidestGap) continue;
      const MarrowRegion both = joined(own, part);
      const BoneOutline longer = outline_of(both);
      if (!is_in_a_row(longer, outline, all_.outlines[g])) continue;
      const double then = in_place(e, longer, both);
      if (then > least) continue;
      least = then;
      best = g;
    }
    return best;
  }

  BoneHypotheses all_;
  const ScanLevels& levels_;
  geometry::RayQuery skin_;
  Box3 seen_;
  std::vector<BoneOutline> expected_;
  int count_;
  std::vector<std::array<int, 2>> links_;
  LinkCosts link_costs_;
  std::vector<std::vector<int>> rays_;    // from the metacarpal outwards
  std::vector<std::vector<int>> beside_;  // in the same ray
  std::vector<Vec3> shift_;
  std::vector<Vec3> ahead_;  // where a finger's last bone points to
  std::vector<char> may_be_split_, is_forearm_;
  std::vector<std::vector<double>> cost_;  // of the model's bones, of hypotheses
  std::vector<int> found_;
  std::vector<char> is_used_;
};

}  // namespace

/// A shaft whose marrow is too thin to be seen leaves two ends in a row.
BoneHypotheses bone_hypotheses(const std::vector<MarrowRegion>& candidates,
                               const ScanLevels& levels, double longest) {
  BoneHypotheses all;
  std::set<std::vector<std::int32_t>> known;  // joined ones, by what they hold
  all.single = static_cast<int>(candidates.size());
  const auto add = [&](MarrowRegion region) {
    all.outlines.push_back(outline_of(region));
    all.cost.push_back(marrow_cost(region, levels));
    all.regions.push_back(std::move(region));
  };
  for (const MarrowRegion& candidate : candidates) add(candidate);
  std::vector<std::vector<int>> parts;  // single regions of each hypothesis
  for (int k = 0; k < all.single; ++k) parts.push_back({k});
  std::map<std::pair<int, int>, double> gaps;
  const auto gap_of = [&](int a, int b) {
    const auto [at_pair, is_new] = gaps.try_emplace({a, b}, 0.0);
    if (is_new) at_pair->second = gap_between(all.regions[a], all.regions[b]);
    return at_pair->second;
  };
  // `b` is a single one.
  const auto add_joined = [&](int a, int b) {
    const BoneOutline &first = all.outlines[a], &second = all.outlines[b];
    const MarrowRegion &m = all.regions[a], &n = all.regions[b];
    if (all.cost[a] > kLikeMarrow || all.cost[b] > kLikeMarrow) return;
    if (overlap(m, n) || !is_alike(m, n, levels) || !is_alike(n, m, levels)) return;
    const double apart = (first.centre - second.centre).norm();
    if (apart > longest || apart > 0.5 * (first.length + second.length) + kWidestGap) return;
    double gap = std::numeric_limits<double>::infinity();
    for (const int part : parts[a]) gap = std::min(gap, gap_of(part, b));
    if (gap > kWidestGap) return;
    MarrowRegion both = joined(m, n);
    const BoneOutline outline = outline_of(both);
    if (!is_in_a_row(outline, first, second) || outline.length > longest) return;
    std::vector<std::int32_t> regions = both.regions;
    std::sort(regions.begin(), regions.end());
    if (!known.insert(std::move(regions)).second) return;
    parts.push_back(parts[a]);
    parts.back().push_back(b);
    add(std::move(both));
  };
  for (int a = 0; a < all.single; ++a) {
    for (int b = a + 1; b < all.single; ++b) add_joined(a, b);
  }
  const int pairs = static_cast<int>(all.regions.size());
  for (int a = all.single; a < pairs; ++a) {
    for (int b = 0; b < all.single; ++b) add_joined(a, b);
  }
  return all;
}

BonePairing pair_bones(const BoneHypotheses& hypotheses, const ScanLevels& levels,
                       const geometry::TriangleMesh& skin, const hand::Hand& model,
                       const std::vector<std::vector<BoneOutline>>& expected) {
  std::vector<std::optional<Pairer>> pairers(expected.size());
  std::vector<double> cost(expected.size(), 0.0);
  parallel_for(static_cast<int>(expected.size()), [&](int k) {
    pairers[k].emplace(hypotheses, levels, skin, model, expected[k]);
    cost[k] = pairers[k]->pair();
  });
  const auto best = std::min_element(cost.begin(), cost.end());
  BonePairing pairing = pairers[best - cost.begin()]->finish();
  pairing.cost = *best;
  return pairing;
}

}  // namespace palmar::capture
