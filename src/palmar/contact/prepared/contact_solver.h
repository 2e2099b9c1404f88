// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/contact/bone/loaded_skin.h"
#include "palmar/contact/contact.h"
#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/contact/prepared/skin_displacement.h"
#include "palmar/contact/self/meeting_loads.h"
#include "palmar/contact/solve/contact_system.h"
#include "palmar/contact/solve/skin_product.h"
#include "palmar/contact/tissue/modulus_search.h"

namespace palmar::contact {

constexpr double kPressedNear = 2.0;  ///< mm; skin that far off the product says nothing of it
constexpr double kBulgeRange = 2.0;   ///< mm; gaps beyond this don't close by bulging: twice what a
                                      ///< flank pressed at the limit depth bulges. Ours

/// Appends a sentence to a result's message.
void append_note(std::string& message, const std::string& text);

/// What stands behind ContactSolver and solve_hand_contact(); the contact of one hand, with its
/// memory.
struct ContactSolver::Impl {
  Impl(const PreparedHand& prepared_hand, const ContactOptions& contact_options);

  /// `only`: the skin of other regions is let through (indentation test of one region).
  void solve(const std::vector<Vec3>& posed_skin, const geometry::Rigid3& product_from_hand,
             const geometry::DistanceField& product, std::optional<hand::Region> only,
             ContactResult& result);
  /// The same for who wants forces only: loaded skin is put on the product, all else stays where it
  /// was; of pressures none, of regions and totals just force, largest penetration and shear
  /// modulus are set. A third of the time. On bone moduli are settled to `accuracy` [relative], and
  /// forces with them.
  void solve_forces(const std::vector<Vec3>& posed_skin, const geometry::Rigid3& product_from_hand,
                    const geometry::DistanceField& product, double accuracy, ContactResult& result);

  /// How the forces of the last solve_forces() change, -dp [N], with the distances of loaded skin
  /// to the product, `change` [mm], a row for each vertex of loaded_vertices(), and with the
  /// directions in which it is pressed: `turns`, per such vertex (column, turn of the direction
  /// against the skin, product frame, rad); empty: they are held. The set of loaded skin is held,
  /// moduli follow (block_energy.h). With directions held -dp/dd is symmetric and positive
  /// definite. `accuracy`: relative. Nothing where the tissue isn't on bone, or with coatings or
  /// skin on skin in touch.
  std::optional<Eigen::MatrixXd> stiffness_times(const Eigen::MatrixXd& change,
                                                 const LoadedSkin::Turns& turns, double accuracy);

  const PreparedHand* hand;
  const PreparedHand::Impl* prepared;
  ContactOptions options;
  ContactSystem system;
  // Of the last call, per skin vertex; empty before the first.
  std::vector<char> was_in_contact;
  std::vector<double> was_force;  ///< N
  /// In place of what find_skin_on_product() finds at these vertices; empty in any call of ours.
  std::vector<std::pair<int, geometry::DistanceSample>> aimed;
  const SkinOnProduct& skin() const { return skin_; }  ///< of the last call
  /// Unit, out of the product: the direction in which it pressed a loaded vertex in the last call
  /// (on bone; else its normal there).
  Vec3 pressed_along(int vertex) const {
    return prepared->is_on_bone() ? pressed_along(skin_, vertex) : skin_.sample[vertex].normal;
  }
  /// How the forces of a result move skin on bone at some vertices, product frame, mm; after
  /// solve().
  std::vector<Vec3> motion_on_bone(const ContactResult& result, const std::vector<int>& at) const;

 private:
  void take_aimed();
  Vec3 pressed_along(const SkinOnProduct& skin, int v) const;
  void find_meetings(const std::vector<Vec3>& posed, std::optional<hand::Region> only);
  void add_touches(ContactResult& result) const;
  SkinLoad find_forces(const std::vector<Vec3>& posed_skin,
                       const geometry::Rigid3& product_from_hand,
                       const geometry::DistanceField& product, std::optional<hand::Region> only,
                       double wanted, ContactResult& result);
  /// Skin outside the problem may come to touch as other skin is pressed.
  bool may_bulge() const;
  /// Compliance of the product's coatings among the rows of a load, times the geometric mean of the
  /// rows' shear moduli, 1/mm; symmetric.
  struct CoatingCompliance {
    std::vector<double> diagonal;               ///< empty without coatings
    std::vector<ContactSystem::Entry> entries;  ///< row > column
  };

  void set_depth(const SkinOnProduct& skin, SkinLoad& load) const;
  std::vector<double> moduli(const SkinLoad& load, hand::TissueLevel level) const;
  /// The coating over a point of the surface; -1 for none.
  int coating_at(const Vec3& at) const;
  void set_coating(const SkinOnProduct& skin, const SkinLoad& load);
  /// How far a coating gives way at skin vertex v under the load, mm.
  double coating_displacement(const SkinOnProduct& skin, const SkinLoad& load, std::size_t v) const;
  void assemble(const SkinOnProduct& skin, const SkinLoad& load);
  bool solve_system(const SkinOnProduct& skin, SkinLoad& load, ContactResult& result);
  bool solve_on_bone(const SkinOnProduct& skin, SkinLoad& load, bool may_extend,
                     ContactResult& result);
  BlockStiffening next_stiffening(const SkinLoad& load,
                                  const std::vector<double>& displacement) const;
  void extend(const std::vector<int>& more, SkinLoad& load) const;
  double bone_root_modulus(hand::TissueLevel level, const BlockRoots& roots, int v) const;
  std::vector<double> skin_roots(hand::TissueLevel level, const BlockRoots& roots) const;
  void set_bone_moduli(const BlockRoots& roots, SkinLoad& load) const;
  Eigen::Matrix3d to_reference(const SkinOnProduct& skin, int v) const;
  std::vector<Vec3> reference_directions(const SkinOnProduct& skin,
                                         const std::vector<int>& vertices) const;
  std::vector<int> pressed_in_on_bone(const SkinOnProduct& skin, const SkinLoad& load,
                                      const BlockRoots& roots) const;
  void displace_on_bone(const SkinOnProduct& skin, const SkinLoad& load, SkinDisplacement& u) const;
  void solve_by_region(const SkinOnProduct& skin, SkinLoad& load, ContactResult& result);
  void solve_load(const SkinOnProduct& skin, SkinLoad& load, ContactResult& result);
  /// Near skin outside the problem that the solution moves into the product.
  std::vector<int> pressed_in(const SkinOnProduct& skin, const SkinLoad& load) const;
  /// dF / d ln G of each region, N; nothing if the system on the contact set has no solution.
  std::optional<std::array<double, hand::kRegionCount>> force_per_modulus_on_bone(
      const SkinOnProduct& skin, const SkinLoad& load);
  std::optional<std::array<double, hand::kRegionCount>> force_per_modulus(const SkinOnProduct& skin,
                                                                          const SkinLoad& load);
  ContactBand band(const SkinOnProduct& skin, const SkinLoad& load, const std::vector<double>& gap,
                   const SkinGeometry& pressed, ContactResult& nominal);

  // Xie 2014 as printed; solve_as_printed.cpp.
  SkinLoad solve_as_printed(const SkinOnProduct& skin, hand::TissueLevel level,
                            ContactResult& result) const;
  static void deform_as_printed(const SkinOnProduct& skin, const SkinLoad& load,
                                ContactResult& result);
  void finish_as_printed(const SkinOnProduct& skin, const geometry::DistanceField& product,
                         const SkinLoad& load, ContactResult& result) const;
  ContactBand band_as_printed(const SkinOnProduct& skin, ContactResult& nominal) const;

  CoatingCompliance coating_;
  std::optional<LoadedSkin> loaded_;               ///< of tissue on bone
  std::optional<MeetingLoads> on_self_;            ///< the same; skin on skin of the call under way
  const std::vector<Vec3>* undeformed_ = nullptr;  ///< of the call under way
  BlockStiffening stiffening_ = no_stiffening();   ///< after the last solution on bone
  ModulusSearch search_;
  SkinLoad last_;             ///< of the last solve_forces()
  bool forces_only_ = false;  ///< the call under way is solve_forces()
  double forces_accuracy_ = 0.0;
  SkinSampler sampler_;
  SkinOnProduct skin_;
};

/// Enters forces, areas and peaks of the low or the high tissue into the rows of a band.
void set_band_level(const ContactResult& at_level, hand::TissueLevel level, ContactBand& band);

}  // namespace palmar::contact
