// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/contact/press/press.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/records/fe/tet_mesh.h"

namespace palmar::records {

/// Law of the soft tissue in a finite-element deck.
enum class DeckMaterial {
  kLinear,    ///< linear elastic at small strain: what Palmar's contact assumes
  kNeoHooke,  ///< compressible neo-Hookean at large strain and rotation
};

/// A rigid body pressed into a tissue block, for CalculiX (or Abaqus): second-order tetrahedra held
/// at the bone, frictionless surface-to-surface contact with penalty.
struct PressDeck {
  std::string title;                ///< one line, a comment on top
  BlockMesh block;                  ///< tissue, mm
  geometry::TriangleMesh indenter;  ///< its surface towards the skin, at first touch, mm
  Vec3 direction = -Vec3::UnitZ();  ///< unit; the way the indenter moves
  std::vector<double> depths;       ///< mm from first touch, ascending; one step each
  double shear_modulus = 0.01;      ///< MPa
  double poisson = 0.495;           ///< below 0.5
  DeckMaterial material = DeckMaterial::kLinear;
  bool is_cut_held = true;  ///< nodes of the cut face fixed; else free
  /// Penalty [MPa/mm]: skin enters the indenter by pressure / penalty. Unset: 300 times Young's
  /// modulus per mm, which at the usual pressures of a tenth of it means less than 0.001 mm.
  std::optional<double> penalty;
  double young() const { return 2.0 * shear_modulus * (1.0 + poisson); }
  void check() const;       ///< throws UsageError
  void check_test() const;  ///< the same of depths, tissue and penalty alone
};

/// The deck as text. Units mm, N, MPa. Sets: nodes BONE, CUT, INDENTER; elements TISSUE, RIGID;
/// surfaces SKIN (of the tissue), TOOL. Nodes of the indenter follow those of the tissue. Per step
/// it prints the reaction on the indenter and the contact's totals, and writes displacements,
/// stresses and contact pressures.
std::string inp_deck(const PressDeck& deck);

/// The indenter's surface towards the skin in the hand frame, wide enough for depths of some
/// millimetres: a square plate, the cap of a sphere, part of a cylinder. Flat facets of 0.4 mm
/// stand off a sphere of 10 mm by 0.002 mm. Throws UsageError on punches: a sharp edge needs a
/// finer mesh than this one.
geometry::TriangleMesh indenter_surface(const contact::PressIndenter& indenter,
                                        const geometry::Rigid3& hand_from_indenter);

}  // namespace palmar::records
