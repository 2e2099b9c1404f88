// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/contact/response/sparse_rows.h"
#include "palmar/contact/skin_touch.h"

namespace palmar::contact {

/// Skin on skin in the contact problem of a hand on bone (contact_on_bone.cpp): beside the forces
/// p_i of the product one unknown f_k >= 0 for each meeting, which acts on the vertex along the
/// normal and on the triangle's corners against it. With x_ka, the share of f_k that acts on vertex
/// a, as a vector in the reference posture, C the skin's compliance and tau_a of block_energy.h,
///
///     gap_k = d_k + sum_a x_ka . u_a,    u_a = tau_a sum_b C_ab tau_b (loads on b)
///
/// so the rows of both kinds are those of one symmetric matrix B' C B, and work on either skin is
/// that of the same forces. Solved for q_k = f_k / r_k with the row times r_k, r_k = 1 / tau of the
/// vertex that presses. Frictionless. What is pointed to must outlive it.
class MeetingLoads {
 public:
  /// `scale` as in LoadedSkin.
  MeetingLoads(const SkinGeometry& reference, const SkinCompliance& compliance,
               const std::vector<double>& scale);

  /// Takes the meetings of a posture whose skin has the compliance: those that cross, and those
  /// that had a force in the call before. Of the others extend() may take more. Posed skin and its
  /// normals in the frame of the meetings.
  void set(const std::vector<SkinMeeting>& meetings, const std::vector<Vec3>& posed,
           const std::vector<Vec3>& normal);
  void clear() {
    meeting_.clear();
    near_.clear();
  }
  bool is_empty() const { return meeting_.empty(); }
  bool may_grow() const { return !near_.empty(); }  ///< whether extend() has anything to look at

  /// Takes more meetings, whose skins bulge onto each other under the forces [N] of the product and
  /// of the meetings so far. Whether there are any; then join() and responses() are due again.
  bool extend(const std::vector<int>& vertices, const std::vector<Vec3>& directions,
              const std::vector<double>& force, const std::vector<double>& root);

  /// The rows of the product: vertices, ascending, with directions in the reference posture.
  void join(const std::vector<int>& vertices, const std::vector<Vec3>& directions);
  /// Responses of both, meetings after the product, whose own are given; 1/mm. `root`: 1 / tau per
  /// skin vertex, sqrt(MPa).
  const SparseRows& responses(const SparseRows& of_product, const std::vector<double>& root);
  /// The skin vertex of each row; that which presses, of a meeting.
  std::vector<int> rows(const std::vector<int>& of_product) const;

  /// Puts the rows of the meetings behind those of the product, and takes them off again: b [N/mm
  /// by sqrt(MPa)], contact set, q and gaps of ContactSystem.
  void append(std::vector<double>& b, std::vector<char>& in_contact, std::vector<double>& q) const;
  void take_off(std::vector<double>& b, std::vector<char>& in_contact, std::vector<double>& q,
                std::vector<double>& gap);
  /// The contact set of the last solution, that of the product given.
  std::vector<char> with_contact(const std::vector<char>& of_product) const;
  /// Largest |gap force| of a meeting in the last solution, N mm.
  double complementarity() const;

  /// Appends, for stiffening_of(), what every corner of a meeting in contact does: vertex, force
  /// [N] and displacement along it [mm]. `product_force` [N] in the order of join().
  void add_work(const std::vector<double>& product_force, std::vector<int>& vertex,
                std::vector<double>& force, std::vector<double>& displacement) const;
  /// Adds to dF / d ln G, by region, what the moduli under the meetings do: with q of the solution
  /// and y of A y = root (rows of the product), 1/2 sum_a (y_a . u_a(q) + q_a . u_a(y)).
  void add_slopes(const std::vector<double>& product_q, const std::vector<double>& y,
                  const std::vector<hand::Region>& region,
                  std::array<double, hand::kRegionCount>& slope) const;

  /// How far the meetings' forces alone move skin at these vertices: in the frame of the posed
  /// skin, mm. Zero for skin without the compliance.
  std::vector<Vec3> displacement(const std::vector<int>& at) const;
  /// The same in the reference posture, where the tissue is.
  std::vector<Vec3> reference_displacement(const std::vector<int>& at) const;
  /// Corners of all meetings, those that don't touch included, ascending.
  std::vector<int> corners() const;
  /// How far these vertices go under all forces, those of the product given, posed frame, mm.
  std::vector<Vec3> whole_displacement(const std::vector<int>& at, const std::vector<int>& vertices,
                                       const std::vector<Vec3>& directions,
                                       const std::vector<double>& force) const;

  /// Meetings with force, ascending.
  std::vector<SkinTouch> touches() const;

 private:
  static constexpr std::size_t kCorners = 4;  // the vertex, then the triangle's
  struct Meeting {
    SkinMeeting at;
    std::array<int, kCorners> vertex{};
    std::array<Vec3, kCorners> share;  ///< x_ka, reference posture
    double force = 0.0, gap = 0.0;     ///< N, mm
    double was_root = 0.0;             ///< r_k of the last solution; 0: none
    bool in_contact = false;
  };
  /// Of a row on a vertex: times factor(row, vertex) the vector that C multiplies.
  struct Load {
    int row = 0;
    Vec3 vector = Vec3::Zero();
  };
  struct Tensor {
    int a = 0, b = 0;       ///< slots, the entry's own and the other
    std::size_t entry = 0;  ///< in the compliance
  };
  /// From a slot to another that its loads move.
  struct Link {
    int slot = 0;
    bool is_other = false;  ///< the other of the entry: what moves it is the transpose
    std::size_t entry = 0;  ///< in the compliance
  };
  /// Loads of meetings and product on the skin, over the roots of its moduli.
  struct Field {
    std::vector<Vec3> load;       ///< per skin vertex
    std::vector<char> is_loaded;  ///< likewise
    std::vector<int> vertex;      ///< those that are
  };
  Field field_of_meetings() const;
  void add_product(const std::vector<int>& vertices, const std::vector<Vec3>& directions,
                   const std::vector<double>& force, Field& field) const;
  std::vector<Vec3> moved_by(const Field& field, const std::vector<int>& at) const;
  Eigen::Matrix3d to_posed(int vertex) const;
  double factor(const Load& load, int vertex) const;
  std::vector<Vec3> slot_displacement(const std::vector<double>& product_q,
                                      const std::vector<double>& meeting_q) const;
  std::vector<double> meeting_q() const;

  const SkinGeometry* reference_;
  const SkinCompliance* compliance_;
  std::vector<double> root_scale_;  // 1 / sqrt(scale) per skin vertex
  std::vector<int> row_of_;         // per skin vertex, in the compliance; -1 for none
  const std::vector<Vec3>*posed_ = nullptr, *normal_ = nullptr;
  std::vector<double> root_;  // of responses()
  std::vector<Meeting> meeting_;
  std::vector<Meeting> near_;       // that may come to touch
  std::vector<double> last_force_;  // per skin vertex, of the meetings before these
  std::size_t product_rows_ = 0;
  std::vector<int> slot_;                // per skin vertex; -1 for none
  std::vector<int> vertex_;              // of each slot
  std::vector<std::vector<Load>> load_;  // on each slot
  std::vector<Tensor> tensor_;
  std::vector<std::size_t> link_begin_;  // per slot with a meeting's load
  std::vector<Link> link_;
  SparseRows responses_;
};

}  // namespace palmar::contact
