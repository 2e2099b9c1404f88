// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/contact/skin_touch.h"
#include "palmar/geometry/distance/distance_field.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/hand.h"

namespace palmar::contact {

/// Response of the skin to a vertex force (docs/method/contact.md).
enum class Kernel {
  kPatch,  ///< uniform pressure on the vertex's Voronoi disc; mesh-independent (default)
  kPoint   ///< Xie 2014, eq. (3-1), (3-2): point force, r held at 0.5 mm
};

/// What stands under the skin.
enum class TissueModel {
  kHalfSpace,  ///< tissue without end; its stiffening with depth stands for the bone (Xie 2014)
  kLayered,    ///< a layer as thick as the skin's depth over bone, bonded to it
  kBone        ///< the tissue between the skin and the hand's own bones, by finite elements
};

/// Whether the skin of one region lifts that of its neighbours.
enum class RegionCoupling {
  kCoupled,     ///< one problem over the whole hand, each row with its own shear modulus
  kIndependent  ///< every sub-active region alone (Xie 2014)
};

/// Where the distances on the skin come from.
enum class SkinDistance {
  kSurface,  ///< geodesics on the mesh
  kIsomap    ///< Xie 2014: each region flattened by Isomap, straight lines in the flat picture;
             ///< independent regions only, else kSurface
};

/// Law of the bulge's height, and with it the procedure.
enum class BulgeLaw {
  kHeld,    ///< a0 is the height itself, reached at 1 N; rises smoothly from the contact's edge
  kPrinted  ///< Xie 2014, A3 to A7 and eq. (3-5) to (3-15) as printed: the bulge, a = a0 G0 / G
            ///< per newton, is part of the response matrix (docs/method/xie2014.md); independent
            ///< regions of half-spaces only, else kHeld
};

/// The equations of the skin. PreparedHand depends on them; the default is the preset `palmar`.
struct ContactModel {
  Kernel kernel = Kernel::kPatch;
  TissueModel tissue = TissueModel::kHalfSpace;
  RegionCoupling coupling = RegionCoupling::kCoupled;
  SkinDistance distance = SkinDistance::kSurface;
  BulgeLaw bulge = BulgeLaw::kHeld;
  bool operator==(const ContactModel&) const = default;
};

/// What Palmar computes with unless told otherwise: ContactModel{} with the tissue on the hand's
/// own bones. (ContactModel{} itself, a half-space, serves skins that have no bones.)
ContactModel palmar_model();
/// Tissue on bone is one body: with the point kernel or independent regions the half-space stands
/// in its place.
ContactModel with_permitted_tissue(ContactModel model);

/// Every equation as in Xie 2014 (docs/method/xie2014.md): point kernel, half-space, independent
/// regions, Isomap, the bulge in the response matrix.
ContactModel xie2014_model();

/// "palmar" or "xie2014"; nothing for another name.
std::optional<ContactModel> contact_model_named(const std::string& preset);
/// "palmar", "xie2014", or the names of what differs from `palmar`, as in "palmar, independent".
std::string name_of(const ContactModel& model);
std::string_view name_of(Kernel kernel);            ///< "patch", "point"
std::string_view name_of(TissueModel tissue);       ///< "halfspace", "layered", "bone"
std::string_view name_of(RegionCoupling coupling);  ///< "coupled", "independent"
std::string_view name_of(SkinDistance distance);    ///< "surface", "isomap"
std::string_view name_of(BulgeLaw bulge);           ///< "held", "printed"

// All that have a name.
inline constexpr std::array kKernels{Kernel::kPatch, Kernel::kPoint};
inline constexpr std::array kTissueModels{TissueModel::kHalfSpace, TissueModel::kLayered,
                                          TissueModel::kBone};
inline constexpr std::array kRegionCouplings{RegionCoupling::kCoupled,
                                             RegionCoupling::kIndependent};
inline constexpr std::array kSkinDistances{SkinDistance::kSurface, SkinDistance::kIsomap};
inline constexpr std::array kBulgeLaws{BulgeLaw::kHeld, BulgeLaw::kPrinted};

/// Elastic cover of a product (rubber sleeve, foam), bonded to a rigid core. The skin meets its
/// outside; skin and cover give way in series.
struct Coating {
  double thickness = 0.0;      ///< mm
  double shear_modulus = 0.0;  ///< MPa
  double poisson = 0.5;
  Box3 where;  ///< product frame, mm; surface in it is covered. Empty: the whole product
};

struct ContactOptions {
  bool swelling = true;     ///< bulge around the contact, Xie 2014, eq. (3-5) to (3-8)
  double cell_area = 24.0;  ///< mm^2; sensor cell for the averaged peak (Xie 2014: 4.2 cells/cm^2)
  std::optional<double> shear_modulus;  ///< MPa; replaces G everywhere if set
  std::vector<Coating> coatings;  ///< of the product; the first whose box holds a point counts
  bool error_band = false;        ///< solve again with low and high tissue: ContactResult::band
  /// Skin of the hand presses on other skin of it (self/meeting_loads.h); with tissue on bone
  /// alone, else UsageError.
  bool skin_on_skin = false;
  /// Refine the skin on sharp edges and small fillets of the product (refine/refine_contact.h);
  /// by solve_hand_contact() alone, never along a motion, with Kernel::kPatch and BulgeLaw::kHeld.
  bool refine = false;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

class HandFamily;
struct CoarseHand;
struct SkinCompliance;

/// A hand with its geodesic distances and response matrices; they depend on the hand alone, so
/// prepare once and solve many. Immutable, shareable between threads.
class PreparedHand {
 public:
  /// Throws UsageError on a bad hand or layered tissue with the point kernel. Cost: about 1 s for
  /// 10 000 vertices on one core.
  /// TissueModel::kBone: 13 s more, unless `compliance` (skin_compliance.h) is given; it is the
  /// hand's own, or that of `base`, a hand of another size with the same mesh, and then scaled
  /// (loaded_skin.h). Throws UsageError if triangles or regions differ from the base's.
  explicit PreparedHand(std::shared_ptr<const hand::Hand> hand, const ContactModel& model = {},
                        std::shared_ptr<const SkinCompliance> compliance = nullptr,
                        const std::shared_ptr<const hand::Hand>& base = nullptr);
  /// The same for a hand of the family's mesh, much faster (hand_family.h). Throws UsageError also
  /// if triangles or regions differ from the base's.
  PreparedHand(std::shared_ptr<const hand::Hand> hand, const HandFamily& family);
  ~PreparedHand();
  PreparedHand(PreparedHand&&) noexcept;
  PreparedHand& operator=(PreparedHand&&) noexcept;

  const hand::Hand& hand() const;
  const ContactModel& model() const;
  /// The hand with a coarse skin (prepared/coarse_hand.h), made when it is first asked for.
  const CoarseHand& coarse() const;

  struct Impl;
  /// Of parts that were made elsewhere (contact/refine, contact/prepared).
  explicit PreparedHand(std::unique_ptr<const Impl> impl);
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<const Impl> impl_;
};

/// Contact in one region; region-wise totals.
struct RegionContact {
  hand::Region region{};
  double force = 0.0;                ///< sum of vertex forces, N
  Vec3 force_vector = Vec3::Zero();  ///< of the skin on the product, product frame, N
  double area = 0.0;                 ///< contact area on the product, mm^2
  double peak_pressure = 0.0;        ///< largest vertex pressure, MPa
  double peak_pressure_cells = 0.0;  ///< largest mean over a sensor cell, MPa
  double mean_pressure = 0.0;        ///< force / area, MPa
  Vec3 centre = Vec3::Zero();        ///< centre of pressure, product frame, mm
  double max_penetration = 0.0;      ///< d_max before deformation, mm
  double shear_modulus = 0.0;        ///< G(d_max), MPa
  /// Of the force, N: on edges of the product that are sharper than the skin's mesh (resolution.h);
  /// pressures there are not resolved.
  double unresolved_force = 0.0;
};

/// Results of low, nominal and high tissue side by side, for one region or the whole hand.
struct ContactBandRow {
  hand::Region region{};                                     ///< meaningless in the row of totals
  double force_low = 0.0, force_high = 0.0;                  ///< N
  double area_low = 0.0, area_high = 0.0;                    ///< mm^2
  double peak_pressure_low = 0.0, peak_pressure_high = 0.0;  ///< MPa
  double peak_pressure_cells_low = 0.0, peak_pressure_cells_high = 0.0;  ///< MPa
  /// By how much the hand's total force grows with this region's shear modulus, dF / d ln G, N; of
  /// the whole hand: with all moduli. Exact where the set of loaded vertices stays.
  double force_per_modulus = 0.0;
};

struct ContactBand {
  std::vector<ContactBandRow> regions;  ///< regions in contact at nominal tissue, ascending
  ContactBandRow total;
};

enum class ContactStatus {
  kSolved,
  kNoContact,
  kNotConverged,
  kTooDeep  ///< palmar skin lies deeper in the product than kMaxContactDepth; it carries no force
};

/// Skin deeper in the product than this is no contact that a half-space can describe (twice the
/// limit depth of the palm); it is left out of the solution and reported.
constexpr double kMaxContactDepth = 15.0;  // mm

/// How often the solver had to leave its usual way in one call, the error band's included; all 0 as
/// a rule.
struct ContactFallbacks {
  int refused_matrices = 0;   ///< systems with a matrix that has no Cholesky factors
  int gradient_limits = 0;    ///< systems that conjugate gradients did not solve in 500 steps
  int exchange_limits = 0;    ///< systems whose contact set was not found in 400 exchanges
  int dense_solutions = 0;    ///< systems that dense block pivoting solved in their place
  int lemke_solutions = 0;    ///< systems that Lemke's method solved after all these
  int by_region = 0;          ///< coupled problems without solution, solved region by region
  int unsolved_regions = 0;   ///< regions without solution, which carry no force
  int extension_limits = 0;   ///< problems left with skin that bulges into the product
  int stiffening_limits = 0;  ///< problems whose stiffening did not become steady in 40 rounds
  int without_bulge = 0;      ///< xie2014: regions solved with the bulge left out of the equations
  int band_levels = 0;        ///< levels or slopes of the error band without solution

  ContactFallbacks& operator+=(const ContactFallbacks& other);
  bool operator==(const ContactFallbacks&) const = default;
};

/// A count of ContactFallbacks with its name, as in files ("lemke_solutions"), and what it says of
/// the result, as in "... systems were solved by Lemke's method".
struct FallbackCount {
  std::string_view name, words;
  int ContactFallbacks::*count;
};
extern const std::array<FallbackCount, 11> kFallbackCounts;

/// All of them in words, or "" if there are none.
std::string fallbacks_in_words(const ContactFallbacks& fallbacks);

struct RefinedContact;

/// What refining the skin did to a contact; see refine/refine_contact.h.
struct ContactRefinement {
  int levels = 0;            ///< how often the skin's edges were halved
  int vertices = 0;          ///< of the skin that were added
  double finest_edge = 0.0;  ///< mean edge where it is finest, reference posture, mm
  double peak_change = 0.0;  ///< by which the last level moved the peaks on cells, relative
  double peak_before = 0.0;  ///< the hand's peak on cells on its own skin, MPa
  bool is_resolved = false;  ///< the last level moved them by less than kResolvedChange
};

/// Contact of a posed hand with a product. Per-vertex fields follow hand.skin; product frame, mm,
/// N, MPa.
struct ContactResult {
  ContactStatus status = ContactStatus::kNoContact;
  ContactModel model;                  ///< the equations that ran
  std::string message;                 ///< what went wrong, or empty
  std::vector<Vec3> undeformed;        ///< posed skin before contact, product frame
  std::vector<Vec3> deformed;          ///< skin after contact, product frame
  std::vector<double> distance;        ///< signed distance before contact, mm (capped far away)
  std::vector<double> displacement;    ///< u: positive into the hand, negative a bulge, mm
  std::vector<double> force;           ///< p, N
  std::vector<double> pressure;        ///< p / area on the product, MPa; see pressed_skin.h
  std::vector<RegionContact> regions;  ///< regions in contact only, ascending
  RegionContact total;                 ///< region field meaningless; totals of all regions
  double complementarity_error = 0.0;  ///< max |s_i p_i| over all regions, N mm, recomputed
  double residual_penetration_contact = 0.0;  ///< largest |distance| of loaded vertices after, mm
  double residual_penetration_other = 0.0;    ///< deepest other vertex after deformation, mm
  int iterations = 0;
  ContactFallbacks fallbacks;
  std::optional<ContactBand> band;  ///< with ContactOptions::error_band
  /// With ContactOptions::skin_on_skin, else empty: single touches of the hand's own skin,
  /// ascending by vertex, with normals in the product frame, and their sums per pair of regions.
  /// None of it is in `force`, `pressure`, `regions` or `total`: it doesn't act on the product.
  std::vector<SkinTouch> skin_touch;
  std::vector<SkinOnSkin> skin_on_skin;
  double residual_crossing = 0.0;  ///< by which skin still crosses other skin after contact, mm
  /// With ContactOptions::refine, where anything had to be refined: `regions`, `total` and `band`
  /// are those of the refined skin, which `refined` has vertex by vertex; all other fields are
  /// those of the hand's own.
  std::optional<ContactRefinement> refinement;
  std::shared_ptr<const RefinedContact> refined;
};

/// Skin against product (Xie 2014, A3-A7). `posed_skin` is in the hand frame; `product_from_hand`
/// places it. The responses, with their geodesic distances and discs, are those of the reference
/// posture, where the tissue is at rest; areas, pressures and sensor cells are those of the skin as
/// it lies on the product (pressed_skin.h).
///
/// With the responses f_ij (times shear modulus) and a shear modulus for each row,
///
///     s_i = (1 / G_i) sum_j f_ij p_j + d_i >= 0,   p >= 0,   s_i p_i = 0.
///
/// d is the signed distance to the product, negative inside. RegionCoupling::kCoupled: one problem
/// over the hand, G_i from the local depth (stiffening.h); kIndependent: f_ij = 0 across regions,
/// G_i = G(d_max) of the region (of the dorsum: of the connected patch). A half-space has no
/// negative response, so only penetrating vertices can carry force and the problem is exact on them
/// alone; of a layer or a soft cover, skin that bulges into the product joins them. How the skin
/// around moves: skin_displacement.h. A bulge that would enter the product is flattened against it
/// without force (Xie 2014, eq. 3-7).
///
/// Loaded skin ends on the product's surface, at its nearest point; other penetrating skin moves
/// along the product's normal, the rest along its own normal (eq. 3-15). Where the nearest surface
/// is on the far side of a thin product (its normal points along the skin's own), the surface is
/// looked for against the skin's normal, the way the skin came; where there is none, the vertex is
/// left out and reported in `message`. Skin that has gone right through a thin product, so that the
/// product lies in its flesh, is pushed back the same way (surface_passed()).
///
/// With BulgeLaw::kPrinted all of this is as the thesis has it instead; docs/method/xie2014.md.
///
/// Never throws on a numerical failure: see status and fallbacks. Throws UsageError on bad options
/// or if posed_skin has not one point per skin vertex.
ContactResult solve_hand_contact(const PreparedHand& prepared, const std::vector<Vec3>& posed_skin,
                                 const geometry::Rigid3& product_from_hand,
                                 const geometry::DistanceField& product,
                                 const ContactOptions& options = {});

/// The same along a motion: keeps its memory and the loaded vertices of the last call, from which
/// the next one starts. The answer is that of solve_hand_contact() but for rounding. One thread at
/// a time; the prepared hand must outlive it.
class ContactSolver {
 public:
  explicit ContactSolver(const PreparedHand& prepared, const ContactOptions& options = {});
  ~ContactSolver();
  ContactSolver(ContactSolver&&) noexcept;
  ContactSolver& operator=(ContactSolver&&) noexcept;

  /// Arguments as solve_hand_contact(); `result` is overwritten, its memory reused.
  void solve(const std::vector<Vec3>& posed_skin, const geometry::Rigid3& product_from_hand,
             const geometry::DistanceField& product, ContactResult& result);

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace palmar::contact
