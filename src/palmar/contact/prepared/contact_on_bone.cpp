// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What ContactSolver does where the tissue lies on bone (block_energy.h).
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "palmar/contact/prepared/contact_solver.h"
#include "palmar/contact/prepared/contact_totals.h"
#include "palmar/core/enum_index.h"

namespace palmar::contact {
namespace {

constexpr int kMostRounds = 60;
constexpr double kSteadyStiffening = 1e-5;  // relative change of a block's modulus, for results
// Accuracy of the solutions on the way, per relative change of the moduli: the last one's; in the
// end; and at most, from nothing or from another posture.
constexpr double kPerChange = 0.01, kPerSteadiness = 0.05, kRough = 1e-3;
// Forces less exact than this look for skin that bulges into the product only at first: it is some
// vertex in a thousand, and forces that count find it.
constexpr double kExactForces = 1e-3;
// Change of the moduli at which it is looked for skin that has come to touch skin.
constexpr double kRoughStiffening = 0.05;

}  // namespace

/// Turns back to the reference posture, by the frames of normal and first edge at a vertex.
Eigen::Matrix3d ContactSolver::Impl::to_reference(const SkinOnProduct& skin, int v) const {
  const SkinGeometry& reference = prepared->skin;
  const auto frame = [](const Vec3& normal, const Vec3& edge) {
    Eigen::Matrix3d axes;
    axes.col(0) = normal;
    axes.col(1) = (edge - edge.dot(normal) * normal).normalized();
    axes.col(2) = normal.cross(axes.col(1));
    return axes;
  };
  const int next = reference.neighbours(v).front();
  const Eigen::Matrix3d before =
      frame(reference.normal[v], reference.position[next] - reference.position[v]);
  const Eigen::Matrix3d posed = frame(skin.normal[v], (*undeformed_)[next] - (*undeformed_)[v]);
  return before * posed.transpose();
}

/// The direction in which the product presses the skin: the mean of its normals at the vertex and
/// its neighbours, by their area and by how much each faces the skin. Skin is no finer than its
/// vertices: it doesn't turn from one facet of a mesh to the next, nor at once where it comes round
/// an edge.
Vec3 ContactSolver::Impl::pressed_along(const SkinOnProduct& skin, int v) const {
  const SkinGeometry& surface = prepared->skin;
  // Nothing of the other side of something thin.
  const auto facing = [&](int w) -> Vec3 {
    const double faces = std::max(0.0, -skin.normal[v].dot(skin.facing[w]));
    return faces * surface.area[w] * skin.facing[w];
  };
  Vec3 sum = facing(v);
  for (const int w : surface.neighbours(v)) {
    const double near = std::clamp(1.0 - skin.sample[w].distance / kPressedNear, 0.0, 1.0);
    if (near > 0.0) sum += near * facing(w);
  }
  return sum.isZero(0.0) ? skin.facing[v] : sum.normalized();
}

/// The directions in which the product presses the skin, turned back with it.
std::vector<Vec3> ContactSolver::Impl::reference_directions(
    const SkinOnProduct& skin, const std::vector<int>& vertices) const {
  std::vector<Vec3> result;
  result.reserve(vertices.size());
  for (const int v : vertices) {
    result.emplace_back(to_reference(skin, v) * pressed_along(skin, v));
  }
  return result;
}

double ContactSolver::Impl::bone_root_modulus(hand::TissueLevel level, const BlockRoots& roots,
                                              int v) const {
  return options.shear_modulus ? std::sqrt(*options.shear_modulus)
                               : root_modulus(prepared->bone, level, roots, v);
}

void ContactSolver::Impl::set_bone_moduli(const BlockRoots& roots, SkinLoad& load) const {
  load.root_modulus.resize(load.vertex.size());
  load.shear_modulus.resize(load.vertex.size());
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    load.root_modulus[k] = bone_root_modulus(load.level, roots, load.vertex[k]);
    load.shear_modulus[k] = load.root_modulus[k] * load.root_modulus[k];
  }
}

std::vector<double> ContactSolver::Impl::skin_roots(hand::TissueLevel level,
                                                    const BlockRoots& roots) const {
  std::vector<double> result(prepared->skin.position.size());
  for (std::size_t v = 0; v < result.size(); ++v) {
    result[v] = bone_root_modulus(level, roots, static_cast<int>(v));
  }
  return result;
}

/// With q = p / sqrt(G) the problem of given moduli reads C q + sqrt(G) d >= 0. The moduli follow
/// from the work of the forces (block_energy.h): a fixed point (modulus_search.h), found in few
/// rounds because the skin's displacements, and with them the energies at the modulus G0, hardly
/// depend on the moduli. Rounds are solved no more exactly than the moduli are known. With
/// `may_extend` skin that bulges into the product joins the problem on the way.
bool ContactSolver::Impl::solve_on_bone(const SkinOnProduct& skin, SkinLoad& load, bool may_extend,
                                        ContactResult& result) {
  std::vector<double> b, displacement;
  std::vector<double> was_root(prepared->skin.position.size(), 0.0);
  if (load.force.size() != load.vertex.size()) load.force.assign(load.vertex.size(), 0.0);
  const double steady = forces_only_ ? forces_accuracy_ : kSteadyStiffening;
  const double finest = kPerSteadiness * steady;
  double accuracy = std::max(kRough, finest);
  bool is_new = true;
  bool is_last = false;
  // No skin bulged into the product when looked at last.
  bool is_whole = !may_extend || (forces_only_ && steady > kExactForces && !was_in_contact.empty());
  search_.begin();
  for (int round = 0; round < kMostRounds; ++round) {
    const BlockRoots roots(stiffening_);
    set_bone_moduli(roots, load);
    if (is_new) {
      load.direction = reference_directions(skin, load.vertex);
      loaded_->set(load.vertex, load.direction);
      b.resize(load.vertex.size());
      displacement.resize(b.size());
      if (!on_self_->is_empty()) on_self_->join(load.vertex, load.direction);
    }
    if (is_new || !options.coatings.empty() || !on_self_->is_empty()) {
      if (on_self_->is_empty()) {
        system.assemble(loaded_->responses(), load.vertex);
      } else {
        system.assemble(on_self_->responses(loaded_->responses(), skin_roots(load.level, roots)),
                        on_self_->rows(load.vertex));
      }
      set_coating(skin, load);
      if (!coating_.diagonal.empty()) {
        std::vector<double> diagonal = coating_.diagonal;
        diagonal.resize(static_cast<std::size_t>(system.size()), 0.0);
        system.add(diagonal, coating_.entries);
      }
    }
    is_new = false;
    for (std::size_t k = 0; k < b.size(); ++k) {
      const int v = load.vertex[k];
      const double root = load.root_modulus[k];
      b[k] = root * skin.sample[v].distance;
      // Tissue of another modulus, moved alike, has forces in proportion.
      load.force[k] *= was_root[v] > 0.0 ? root / (was_root[v] * was_root[v]) : 1.0 / root;
    }
    if (!on_self_->is_empty()) on_self_->append(b, load.in_contact, load.force);
    const ContactSystem::Outcome outcome =
        system.solve(b, load.in_contact, load.force, load.gap,
                     is_last ? ContactSystem::kBestAccuracy : accuracy);
    if (!on_self_->is_empty()) on_self_->take_off(b, load.in_contact, load.force, load.gap);
    result.iterations += outcome.pivots;
    result.fallbacks += outcome.fallbacks;
    if (!outcome.is_solved) return false;
    double complementarity = on_self_->complementarity();
    for (std::size_t k = 0; k < b.size(); ++k) {
      const int v = load.vertex[k];
      was_root[v] = load.root_modulus[k];
      load.force[k] *= was_root[v];
      load.gap[k] /= was_root[v];
      complementarity = std::max(complementarity, std::abs(load.gap[k] * load.force[k]));
      displacement[k] = load.gap[k] - skin.sample[v].distance;
      if (!options.coatings.empty() && load.force[k] > 0.0) {
        displacement[k] -= coating_displacement(skin, load, static_cast<std::size_t>(v));
      }
    }
    double change = 0.0;
    if (!options.shear_modulus && !is_last) {
      const BlockStiffening next = next_stiffening(load, displacement);
      for (std::size_t r = 0; r < next.size(); ++r) {
        change = std::max(change, std::abs(next[r] / stiffening_[r] - 1.0));
      }
      stiffening_ = search_.next(stiffening_, next);
    }
    const bool is_steady = change < steady && accuracy <= finest;
    accuracy = std::clamp(kPerChange * change, finest, std::max(kRough, finest));
    if (may_extend && !is_last && change < kRoughStiffening && on_self_->may_grow() &&
        on_self_->extend(load.vertex, load.direction, load.force, skin_roots(load.level, roots))) {
      is_new = true;
    }
    const bool touches_more = is_new;
    if (!is_whole && is_steady && !is_last) {
      const std::vector<int> more = pressed_in_on_bone(skin, load, roots);
      is_whole = more.empty();
      if (!is_whole) {
        extend(more, load);
        is_new = true;
      }
    }
    // Forces alone need no solution more exact than the moduli.
    const bool is_done = is_steady && is_whole && !touches_more;
    if (is_last || (is_done && forces_only_)) {
      result.complementarity_error = std::max(result.complementarity_error, complementarity);
      return true;
    }
    is_last = is_done;
    if (round == kMostRounds - 2 && !is_last) {
      ++result.fallbacks.stiffening_limits;
      append_note(result.message, "the stiffening of the tissue is not steady after " +
                                      std::to_string(kMostRounds) + " rounds");
      is_last = true;
    }
  }
  return true;
}

BlockStiffening ContactSolver::Impl::next_stiffening(
    const SkinLoad& load, const std::vector<double>& displacement) const {
  if (on_self_->is_empty()) {
    return stiffening_of(prepared->bone, load.level, stiffening_, load.vertex, load.force,
                         displacement);
  }
  std::vector<int> vertex = load.vertex;
  std::vector<double> force = load.force;
  std::vector<double> way = displacement;
  on_self_->add_work(load.force, vertex, force, way);
  return stiffening_of(prepared->bone, load.level, stiffening_, vertex, force, way);
}

/// Takes more vertices into a load, in contact.
void ContactSolver::Impl::extend(const std::vector<int>& more, SkinLoad& load) const {
  SkinLoad larger;
  larger.level = load.level;
  std::size_t k = 0;
  std::size_t m = 0;
  while (k < load.vertex.size() || m < more.size()) {
    const bool is_old = m == more.size() || (k < load.vertex.size() && load.vertex[k] < more[m]);
    larger.vertex.push_back(is_old ? load.vertex[k] : more[m]);
    larger.force.push_back(is_old ? load.force[k] : 0.0);
    larger.in_contact.push_back(is_old ? load.in_contact[k] : 1);
    ++(is_old ? k : m);
  }
  larger.gap.assign(larger.vertex.size(), 0.0);
  larger.depth.assign(larger.vertex.size(), 0.0);
  load = std::move(larger);
}

std::vector<int> ContactSolver::Impl::pressed_in_on_bone(const SkinOnProduct& skin,
                                                         const SkinLoad& load,
                                                         const BlockRoots& roots) const {
  std::vector<char> is_known(skin.sample.size(), 0);
  for (const int v : load.vertex) is_known[v] = 1;
  std::vector<int> near;
  for (const int v : skin.near) {
    const double d = skin.sample[v].distance;
    if (!is_known[v] && d >= 0.0 && d < kBulgeRange) near.push_back(v);
  }
  std::vector<double> share(load.force);
  for (std::size_t k = 0; k < share.size(); ++k) share[k] /= load.root_modulus[k];
  const std::vector<Vec3> direction = reference_directions(skin, near);
  const std::vector<double> moved = loaded_->displacement(share, near, direction);
  std::vector<Vec3> by_skin;
  if (!on_self_->is_empty()) by_skin = on_self_->reference_displacement(near);
  std::vector<int> result;
  for (std::size_t k = 0; k < near.size(); ++k) {
    const auto v = static_cast<std::size_t>(near[k]);
    double gap = skin.sample[v].distance + moved[k] / bone_root_modulus(load.level, roots, near[k]);
    if (!by_skin.empty()) gap += by_skin[k].dot(direction[k]);
    if (!options.coatings.empty()) gap += coating_displacement(skin, load, v);
    if (gap < 0.0) result.push_back(near[k]);
  }
  return result;
}

/// The skin around the contact as the solution has it, along its own normals.
void ContactSolver::Impl::displace_on_bone(const SkinOnProduct& skin, const SkinLoad& load,
                                           SkinDisplacement& u) const {
  std::vector<char> is_known(skin.sample.size(), 0);
  for (const int v : load.vertex) is_known[v] = 1;
  std::vector<int> around;
  std::vector<Vec3> inwards;
  const BlockRoots roots(stiffening_);
  for (std::size_t v = 0; v < is_known.size(); ++v) {
    if (is_known[v] || !u.is_active[v]) continue;
    around.push_back(static_cast<int>(v));
    inwards.emplace_back(-prepared->skin.normal[v]);
  }
  std::vector<double> share(load.force);
  for (std::size_t k = 0; k < share.size(); ++k) share[k] /= load.root_modulus[k];
  const std::vector<double> moved = loaded_->displacement(share, around, inwards);
  for (std::size_t k = 0; k < around.size(); ++k) {
    const int v = around[k];
    u.elastic[v] = moved[k] / bone_root_modulus(load.level, roots, v);
    u.with_bulge[v] = std::max(u.elastic[v], -skin.sample[v].distance);
  }
}

/// With the forces q = p / sqrt(G): A q = -sqrt(G) d and F = sum sqrt(G_i) q_i. With y of
/// A_FF y = sqrt(G), dF / d ln G_i = 1/2 (p_i - y_i sqrt(G_i) d_i), the stiffening held.
std::optional<std::array<double, hand::kRegionCount>>
ContactSolver::Impl::force_per_modulus_on_bone(const SkinOnProduct& skin, const SkinLoad& load) {
  const std::vector<double>& root = load.root_modulus;
  std::vector<double> right = root;  // of skin on skin, which adds nothing to F, zero
  right.resize(static_cast<std::size_t>(system.size()), 0.0);
  const auto y = system.solve_on(on_self_->with_contact(load.in_contact), right);
  if (!y) return std::nullopt;
  std::array<double, hand::kRegionCount> result{};
  if (!on_self_->is_empty()) {
    std::vector<double> q(load.force);
    for (std::size_t k = 0; k < q.size(); ++k) q[k] /= root[k];
    on_self_->add_slopes(q, *y, prepared->hand->region, result);
  }
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    const int v = load.vertex[k];
    result[index_of(prepared->hand->region[v])] +=
        0.5 * (load.force[k] - (*y)[k] * root[k] * skin.sample[v].distance);
  }
  // A cover's own compliance stands in A times the roots of both moduli.
  const auto region_of = [&](std::size_t k) {
    return index_of(prepared->hand->region[load.vertex[k]]);
  };
  for (std::size_t k = 0; k < coating_.diagonal.size(); ++k) {
    result[region_of(k)] -= (*y)[k] * coating_.diagonal[k] * load.force[k] / root[k];
  }
  for (const ContactSystem::Entry& entry : coating_.entries) {
    const auto i = static_cast<std::size_t>(entry.row);
    const auto j = static_cast<std::size_t>(entry.column);
    const double both =
        0.5 * entry.value * ((*y)[i] * load.force[j] / root[j] + (*y)[j] * load.force[i] / root[i]);
    result[region_of(i)] -= both;
    result[region_of(j)] -= both;
  }
  return result;
}

/// With t = tau p and v = C t = u / tau the conditions of a state are tau v + d = 0 on loaded skin
/// and chi_b' = W_b in every block (block_energy.h). Linear in dp and dlambda, with r_b the change
/// of t and U_b that of u with lambda_b at given forces, M the second derivatives of U* there:
///
///     tau C tau dp + U dlambda = -dd - tau D,     U' dp + M dlambda = -r' D,
///
/// D = dC t what turning directions do at given forces.
std::optional<Eigen::MatrixXd> ContactSolver::Impl::stiffness_times(const Eigen::MatrixXd& change,
                                                                    const LoadedSkin::Turns& turns,
                                                                    double accuracy) {
  if (!prepared->is_on_bone() || !options.coatings.empty() || !on_self_->is_empty()) return {};
  const SkinLoad& load = last_;
  std::vector<Eigen::Index> row;  // of the system, per loaded vertex
  std::vector<char> in_contact(load.vertex.size(), 0);
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    if (!(load.force[k] > 0.0)) continue;
    in_contact[k] = 1;
    row.push_back(static_cast<Eigen::Index>(k));
  }
  const auto count = static_cast<Eigen::Index>(row.size());
  if (count == 0 || count != change.rows()) return {};
  Eigen::VectorXd root(count), force(count), v(count);  // root: 1 / tau
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(row[static_cast<std::size_t>(i)]);
    root[i] = load.root_modulus[k];
    force[i] = load.force[k];
    v[i] = -skin_.sample[load.vertex[k]].distance * root[i];
  }
  std::vector<double> full(load.vertex.size(), 0.0);
  const auto spread = [&](const Eigen::VectorXd& x) {
    for (Eigen::Index i = 0; i < count; ++i) full[row[static_cast<std::size_t>(i)]] = x[i];
  };
  const auto gathered = [&](const std::vector<double>& x) {
    Eigen::VectorXd result(count);
    for (Eigen::Index i = 0; i < count; ++i) result[i] = x[row[static_cast<std::size_t>(i)]];
    return result;
  };
  const auto solved = [&](const Eigen::MatrixXd& right) -> std::optional<Eigen::MatrixXd> {
    if (accuracy >= ContactSystem::kSurely) {
      Eigen::MatrixXd all =
          Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(full.size()), right.cols());
      all(row, Eigen::all) = right;
      const auto x = system.solve_roughly_on(in_contact, all, accuracy);
      return x ? std::optional<Eigen::MatrixXd>((*x)(row, Eigen::all)) : std::nullopt;
    }
    Eigen::MatrixXd result(count, right.cols());
    for (Eigen::Index c = 0; c < right.cols(); ++c) {
      spread(right.col(c));
      const auto x = system.solve_on(in_contact, full, accuracy);
      if (!x) return std::nullopt;
      result.col(c) = gathered(*x);
    }
    return result;
  };

  Eigen::MatrixXd turned = Eigen::MatrixXd::Zero(count, change.cols());  // D
  if (!turns.empty()) {
    LoadedSkin::Turns of_load(load.vertex.size());
    std::vector<double> q(load.force);
    for (std::size_t k = 0; k < q.size(); ++k) q[k] /= load.root_modulus[k];
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(row[static_cast<std::size_t>(i)]);
      const Eigen::Matrix3d back = to_reference(skin_, load.vertex[k]);
      for (const auto& [column, turn] : turns[static_cast<std::size_t>(i)]) {
        of_load[k].emplace_back(column, back * turn);
      }
    }
    const Eigen::MatrixXd all = loaded_->turned(q, of_load, static_cast<int>(change.cols()));
    for (Eigen::Index i = 0; i < count; ++i) {
      turned.row(i) = all.row(static_cast<Eigen::Index>(row[static_cast<std::size_t>(i)]));
    }
  }
  const auto found = solved(root.asDiagonal() * change + turned);
  if (!found) return {};
  Eigen::MatrixXd y = *found;  // tau dp with the moduli held

  // Blocks that stiffen.
  std::vector<std::size_t> block;
  for (std::size_t b = 0; b < stiffening_.size(); ++b) {
    if (!options.shear_modulus && stiffening_[b] > 1.0 + kSteadyStiffening) block.push_back(b);
  }
  const auto blocks = static_cast<Eigen::Index>(block.size());
  Eigen::MatrixXd rate = Eigen::MatrixXd::Zero(count, blocks);  // of tau
  Eigen::VectorXd bend = Eigen::VectorXd::Zero(blocks);         // sum of its second rates times p v
  const BoneTissueBlocks& tissue = prepared->bone;
  for (Eigen::Index i = 0; i < count; ++i) {
    const int vertex = load.vertex[row[static_cast<std::size_t>(i)]];
    const double g0 = std::sqrt(tissue.g0[index_of(load.level)][vertex]);
    for (std::size_t s = tissue.begin[vertex]; s < tissue.begin[vertex + 1]; ++s) {
      const auto [b, share] = tissue.share[s];
      const auto at = std::find(block.begin(), block.end(), static_cast<std::size_t>(b));
      if (at == block.end()) continue;
      const double lambda = stiffening_[b];
      const double first = -0.5 * share / (lambda * std::sqrt(lambda) * g0);
      rate(i, at - block.begin()) += first;
      bend[at - block.begin()] += -1.5 * first / lambda * force[i] * v[i];
    }
  }
  Eigen::MatrixXd moved(count, blocks), followed(count, blocks);  // U / tau, C^-1 of it
  Eigen::MatrixXd second = bend.asDiagonal();                     // M
  const Eigen::MatrixXd r = force.asDiagonal() * rate;
  Eigen::MatrixXd owned(count, blocks);
  for (Eigen::Index b = 0; b < blocks; ++b) {
    spread(r.col(b));
    const Eigen::VectorXd own = rate.col(b).cwiseProduct(v).cwiseProduct(root);
    const Eigen::VectorXd response = gathered(system.times(full));
    owned.col(b) = own;
    moved.col(b) = own + response;
    second.col(b) += r.transpose() * response;
    const double K = tissue.per_energy[index_of(load.level)][block[static_cast<std::size_t>(b)]];
    second(b, b) += 2.0 * (stiffening_[block[static_cast<std::size_t>(b)]] - 1.0) / K;
  }
  if (blocks > 0) {
    const auto x = solved(owned);
    if (!x) return {};
    followed = *x + r;
    const Eigen::MatrixXd left = second - moved.transpose() * followed;
    const Eigen::MatrixXd lambda =
        left.ldlt().solve(moved.transpose() * y - r.transpose() * turned);
    y += followed * lambda;
  }
  return root.asDiagonal() * y;
}

}  // namespace palmar::contact
