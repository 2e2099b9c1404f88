// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/refine/refine_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "palmar/contact/prepared/resolution.h"
#include "palmar/contact/refine/divided_hand.h"
#include "palmar/contact/refine/refined_contact.h"
#include "palmar/core/enum_index.h"

namespace palmar::contact {
namespace {

constexpr double kPeakShare = 0.5;  // of the hand's peak on cells; lower ones decide nothing. Ours
constexpr double kAimRange = 2.0;   // mm; skin farther from the product isn't aimed. Our choice
constexpr int kMostAims = 4;
constexpr double kSteadyAim = 0.02;  // relative change of the peaks

bool is_asked_for(const ContactSolver::Impl& solver, const ContactResult& result) {
  const ContactModel& model = solver.prepared->model;
  return solver.options.refine && model.kernel == Kernel::kPatch &&
         model.bulge == BulgeLaw::kHeld && result.status == ContactStatus::kSolved &&
         !is_resolved(result);
}

/// Whether a region's peak on cells is high enough to count.
bool does_count(const RegionContact& region, const ContactResult& contact) {
  return region.peak_pressure_cells >= kPeakShare * contact.total.peak_pressure_cells;
}

/// By how much the peaks on cells that count have changed, relative.
double change_of_peaks(const ContactResult& before, const ContactResult& after) {
  const auto change = [](double was, double is) {
    return std::abs(is - was) / std::max({is, was, std::numeric_limits<double>::min()});
  };
  const double highest = after.total.peak_pressure_cells;
  double most = change(before.total.peak_pressure_cells, highest);
  for (const RegionContact& region : after.regions) {
    if (!does_count(region, after)) continue;
    double was = 0.0;
    for (const RegionContact& old : before.regions) {
      if (old.region == region.region) was = old.peak_pressure_cells;
    }
    most = std::max(most, change(was, region.peak_pressure_cells));
  }
  return most;
}

double finest_edge(const SkinGeometry& skin) {
  double finest = std::numeric_limits<double>::infinity();
  for (int v = 0; v < skin.vertex_count(); ++v) {
    double sum = 0.0;
    for (int k = skin.ring_begin[v]; k < skin.ring_begin[v + 1]; ++k) sum += skin.edge_length[k];
    finest = std::min(finest, sum / static_cast<double>(skin.neighbours(v).size()));
  }
  return finest;
}

/// One halving after the other.
class Refinement {
 public:
  Refinement(const ContactSolver::Impl& own, const geometry::DistanceField& product,
             const ContactResult& result)
      : own_(own),
        product_(product),
        options_(own.options),
        division_(own.prepared->hand->skin.triangles, own.prepared->skin.position,
                  result.undeformed, may_divide(*own.prepared)),
        contact_(result),
        motion_(result.undeformed.size()) {
    options_.error_band = false;
    told_.peak_before = result.total.peak_pressure_cells;
    told_.peak_change = 1.0;
  }

  void run() {
    while (told_.levels < kMostLevels && !told_.is_resolved) {
      std::vector<char> chosen = unresolved();
      const bool is_confirmation = std::count(chosen.begin(), chosen.end(), 1) == 0;
      if (is_confirmation) chosen = divided();
      SkinDivision finer = division_;
      finer.divide(chosen);
      const std::size_t added = finer.ends().size();
      if (added > static_cast<std::size_t>(kMostAdded) || added == division_.ends().size()) return;
      if (!solve(std::move(finer))) return;
      const bool is_change_small = told_.peak_change < kResolvedChange;
      told_.is_resolved = is_change_small && (told_.levels >= 2 || !has_unresolved());
    }
  }

  /// Puts what was found into the result of the hand's own skin.
  void tell(ContactResult& result) {
    if (solver_) {
      if (own_.options.error_band) {
        solver_->options.error_band = true;
        solver_->solve(division_.posed(), geometry::Rigid3(), product_, std::nullopt, contact_);
      }
      told_.vertices = static_cast<int>(division_.ends().size());
      told_.finest_edge = finest_edge(solver_->prepared->skin);
      result.regions = contact_.regions;
      result.total = contact_.total;
      result.band = contact_.band;
      result.iterations += contact_.iterations;
      result.fallbacks += contact_.fallbacks;
      result.refined = std::make_shared<const RefinedContact>(
          RefinedContact{solver_->prepared->hand, std::move(contact_)});
    }
    result.refinement = told_;
  }

 private:
  static std::vector<char> may_divide(const PreparedHand::Impl& hand) {
    std::vector<char> result(hand.skin.position.size(), hand.is_on_bone() ? 0 : 1);
    if (!hand.is_on_bone()) return result;
    for (const int v : hand.compliance->vertex) result[v] = 1;
    return result;
  }

  const ContactSolver::Impl& last() const { return solver_ ? *solver_ : own_; }

  /// Per vertex, whether its region's peak counts; at first every one does.
  std::vector<char> in_regions_that_count() const {
    std::array<char, hand::kRegionCount> counts{};
    for (const RegionContact& one : contact_.regions) {
      counts[index_of(one.region)] = told_.levels == 0 || does_count(one, contact_) ? 1 : 0;
    }
    std::vector<char> result;
    for (const hand::Region region : last().prepared->hand->region) {
      result.push_back(counts[index_of(region)]);
    }
    return result;
  }

  std::vector<char> unresolved() const {
    const SkinGeometry& skin = last().prepared->skin;
    std::vector<char> result = in_regions_that_count();
    for (int v = 0; v < skin.vertex_count(); ++v) {
      if (result[v] == 0) continue;
      result[v] = contact_.force[v] > 0.0 && is_unresolved(skin, last().skin(), v) ? 1 : 0;
    }
    return result;
  }
  bool has_unresolved() const {
    return std::any_of(
        contact_.regions.begin(), contact_.regions.end(), [&](const RegionContact& one) {
          return does_count(one, contact_) && one.unresolved_force > kToldShare * one.force;
        });
  }

  /// Skin that the product or a bulge may reach.
  std::vector<char> near_product(const SkinDivision& finer) const {
    std::vector<char> result(finer.posed().size(), 0);
    for (const int v : last().skin().near) {
      result[v] = last().skin().sample[v].distance < kBulgeRange ? 1 : 0;
    }
    for (std::size_t v = contact_.force.size(); v < result.size(); ++v) {
      for (const int end : finer.ends()[v - finer.original_count()]) {
        if (result[end] != 0) result[v] = 1;
      }
    }
    return result;
  }

  /// Loaded skin inside what was divided, where the peaks are that count.
  std::vector<char> divided() const {
    const SkinGeometry& skin = last().prepared->skin;
    const std::vector<char> counts = in_regions_that_count();
    std::vector<char> is_fine(contact_.force.size(), 0);
    for (std::size_t k = 0; k < division_.ends().size(); ++k) {
      is_fine[division_.original_count() + k] = 1;
      for (const int end : division_.ends()[k]) is_fine[end] = 1;
    }
    std::vector<char> result(contact_.force.size(), 0);
    for (int v = 0; v < skin.vertex_count(); ++v) {
      const std::span<const int> around = skin.neighbours(v);
      const bool is_inside = is_fine[v] != 0 && std::all_of(around.begin(), around.end(),
                                                            [&](int w) { return is_fine[w] != 0; });
      result[v] = is_inside && counts[v] != 0 && contact_.force[v] > 0.0 ? 1 : 0;
    }
    return result;
  }

  bool solve(SkinDivision finer) {
    auto hand = std::make_unique<PreparedHand>(
        divided_hand(*own_.hand, finer, near_product(finer), options_.skin_on_skin));
    auto next = std::make_unique<ContactSolver::Impl>(*hand, options_);
    start(finer, *next);
    ContactResult found;
    next->solve(finer.posed(), geometry::Rigid3(), product_, std::nullopt, found);
    for (int aim = 0; own_.prepared->is_on_bone() && aim < kMostAims; ++aim) {
      if (found.status != ContactStatus::kSolved) return false;
      const ContactResult before = found;
      take_aim(finer, found, *next);
      next->solve(finer.posed(), geometry::Rigid3(), product_, std::nullopt, found);
      if (change_of_peaks(before, found) < kSteadyAim) break;
    }
    if (found.status != ContactStatus::kSolved) return false;
    told_.peak_change = change_of_peaks(contact_, found);
    ++told_.levels;
    solver_ = std::move(next);
    hand_ = std::move(hand);
    division_ = std::move(finer);
    contact_ = std::move(found);
    return true;
  }

  /// The next solution starts from the last one and its aims.
  void start(const SkinDivision& finer, ContactSolver::Impl& next) {
    next.was_in_contact = last().was_in_contact;
    next.was_force.assign(finer.posed().size(), 0.0);
    for (std::size_t v = motion_.size(); v < finer.posed().size(); ++v) {
      const auto [a, b] = finer.ends()[v - finer.original_count()];
      next.was_in_contact.push_back(next.was_in_contact[a] != 0 && next.was_in_contact[b] != 0);
      motion_.emplace_back();
      if (motion_[a] && motion_[b]) motion_[v] = 0.5 * (*motion_[a] + *motion_[b]);
    }
    set_aims(finer, next);
  }

  /// Where the forces move the skin that was divided; not what has come through a thin wall.
  void take_aim(const SkinDivision& finer, const ContactResult& found, ContactSolver::Impl& next) {
    std::vector<char> may_aim(found.force.size(), 0);
    for (std::size_t k = 0; k < finer.ends().size(); ++k) {
      may_aim[finer.original_count() + k] = 1;
      for (const int end : finer.ends()[k]) may_aim[end] = 1;
    }
    for (const int v : next.skin().traced) may_aim[v] = 0;
    std::vector<int> at;
    for (const int v : next.skin().near) {
      if (may_aim[v] != 0 && next.skin().sample[v].distance < kAimRange) at.push_back(v);
    }
    const std::vector<Vec3> moved = next.motion_on_bone(found, at);
    for (std::size_t k = 0; k < at.size(); ++k) motion_[at[k]] = moved[k];
    set_aims(finer, next);
  }

  void set_aims(const SkinDivision& finer, ContactSolver::Impl& next) const {
    next.aimed.clear();
    std::vector<Vec3> ends;
    for (std::size_t v = 0; v < motion_.size(); ++v) {
      if (!motion_[v]) continue;
      next.aimed.emplace_back(static_cast<int>(v), geometry::DistanceSample{});
      ends.emplace_back(finer.posed()[v] + *motion_[v]);
    }
    std::vector<geometry::DistanceSample> found(ends.size());
    product_.sample(ends, kNearRange, found);
    for (std::size_t k = 0; k < ends.size(); ++k) {
      auto& [v, sample] = next.aimed[k];
      sample = found[k];
      sample.distance = (finer.posed()[v] - sample.closest).dot(sample.normal);
    }
  }

  const ContactSolver::Impl& own_;
  const geometry::DistanceField& product_;
  ContactOptions options_;
  SkinDivision division_;
  ContactResult contact_;  // of the last level
  ContactRefinement told_;
  std::vector<std::optional<Vec3>> motion_;  // of aimed vertices, product frame
  std::unique_ptr<PreparedHand> hand_;       // null before the first level
  std::unique_ptr<ContactSolver::Impl> solver_;
};

}  // namespace

void refine_contact(const ContactSolver::Impl& solver, const geometry::DistanceField& product,
                    ContactResult& result) {
  if (!is_asked_for(solver, result)) return;
  Refinement refinement(solver, product, result);
  refinement.run();
  refinement.tell(result);
}

}  // namespace palmar::contact
