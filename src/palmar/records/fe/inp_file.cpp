// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/fe/inp_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "palmar/core/error.h"

namespace palmar::records {
namespace {

constexpr double kPenaltyPerYoung = 300.0;  // 1/mm
constexpr double kIndenterThickness = 1.0;  // mm; rigid, so it doesn't matter

[[noreturn]] void refuse(const std::string& what) { throw UsageError("finite elements: " + what); }

void append_ids(std::string& text, const std::vector<int>& ids, int offset) {
  constexpr std::size_t kPerLine = 10;  // CalculiX takes at most 16
  for (std::size_t i = 0; i < ids.size(); ++i) {
    text += fmt::format("{}{}", ids[i] + offset,
                        i + 1 == ids.size()       ? "\n"
                        : (i + 1) % kPerLine == 0 ? ",\n"
                                                  : ",");
  }
}

void append_node_set(std::string& text, const std::string& name, const std::vector<int>& nodes) {
  text += "*NSET, NSET=" + name + "\n";
  append_ids(text, nodes, 1);
}

/// A grid of (columns + 1) x (rows + 1) points as triangles that face -z if x grows with the
/// columns and y with the rows.
geometry::TriangleMesh grid(int columns, int rows,
                            const std::function<Vec3(double, double)>& place) {
  geometry::TriangleMesh mesh;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      mesh.vertices.push_back(
          place(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i;
      const int b = a + columns + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({a + 1, b, b + 1});
    }
  }
  return mesh;
}

}  // namespace

void PressDeck::check() const {
  if (block.mesh.tets.empty()) refuse("the tissue has no elements");
  if (smallest_jacobian(block.mesh) <= 0.0) refuse("an element of the tissue is inside out");
  if (block.pressed.empty()) refuse("no skin is to be pressed");
  if (block.on_bone.empty()) refuse("no node is held by bone");
  if (indenter.triangles.empty()) refuse("the indenter has no triangles");
  if (std::abs(direction.norm() - 1.0) > 1e-6) {
    refuse(fmt::format("the direction has length {}; a unit vector is required", direction.norm()));
  }
  check_test();
}

void PressDeck::check_test() const {
  if (depths.empty()) refuse("no depth is given");
  double last = 0.0;
  for (const double d : depths) {
    if (!(d > last)) refuse(fmt::format("depth {} mm after {} mm; they must ascend", d, last));
    last = d;
  }
  if (!(shear_modulus > 0.0)) {
    refuse(fmt::format("shear modulus {} MPa; more than 0 is required", shear_modulus));
  }
  if (!(poisson > -1.0 && poisson < 0.5)) {
    refuse(fmt::format("Poisson's ratio {}; above -1 and below 0.5 is allowed", poisson));
  }
  if (penalty && !(*penalty > 0.0)) {
    refuse(fmt::format("penalty {} MPa/mm; more than 0 is required", *penalty));
  }
}

geometry::TriangleMesh indenter_surface(const contact::PressIndenter& indenter,
                                        const geometry::Rigid3& hand_from_indenter) {
  constexpr double kReach = 12.0;  // mm to every side of the point of first touch
  constexpr double kEdge = 0.4;    // mm
  const double radius = indenter.radius;
  const double reach = std::min(kReach, 0.7 * radius);  // of a round one
  const int steps = std::max(2, 2 * static_cast<int>(std::ceil(reach / kEdge)));
  geometry::TriangleMesh mesh;
  switch (indenter.kind) {
    case contact::PressIndenter::Kind::kPlane:
      mesh = grid(2, 2, [](double u, double v) {
        return Vec3(4.0 * kReach * (u - 0.5), 4.0 * kReach * (v - 0.5), 0.0);
      });
      break;
    case contact::PressIndenter::Kind::kCylinder:
      mesh = grid(steps, 2, [&](double u, double v) {
        const double x = 2.0 * reach * (u - 0.5);
        return Vec3(x, 4.0 * kReach * (v - 0.5), radius - std::sqrt(radius * radius - x * x));
      });
      break;
    case contact::PressIndenter::Kind::kSphere:
      // A square grid keeps facets even; its corners lie at sqrt(2) 0.7 of the radius.
      mesh = grid(steps, steps, [&](double u, double v) {
        const double x = 2.0 * reach * (u - 0.5);
        const double y = 2.0 * reach * (v - 0.5);
        return Vec3(x, y, radius - std::sqrt(radius * radius - x * x - y * y));
      });
      break;
    default:
      throw UsageError("finite elements: " + name_of(indenter) +
                       " has a sharp edge; plane, sphere:R or cylinder:R is allowed");
  }
  for (Vec3& v : mesh.vertices) v = hand_from_indenter * v;
  return mesh;
}

std::string inp_deck(const PressDeck& deck) {
  deck.check();
  const TetMesh& mesh = deck.block.mesh;
  std::string text = fmt::format("** {}\n** Units: mm, N, MPa\n*NODE, NSET=TISSUE\n", deck.title);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Vec3& p = mesh.nodes[n];
    text += fmt::format("{},{:.9g},{:.9g},{:.9g}\n", n + 1, p.x(), p.y(), p.z());
  }
  text += "*ELEMENT, TYPE=C3D10, ELSET=TISSUE\n";
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    text += fmt::format("{}", e + 1);
    for (const int n : mesh.tets[e]) text += fmt::format(",{}", n + 1);
    text += '\n';
  }

  // The indenter's triangles as wedges, thick along the press.
  const int tool_nodes = static_cast<int>(mesh.nodes.size());
  const int tool_elements = static_cast<int>(mesh.tets.size());
  const int tool_vertices = deck.indenter.vertex_count();
  text += "*NODE, NSET=INDENTER\n";
  for (int layer = 0; layer < 2; ++layer) {
    for (int v = 0; v < tool_vertices; ++v) {
      const Vec3 p = deck.indenter.vertices[v] - layer * kIndenterThickness * deck.direction;
      text += fmt::format("{},{:.9g},{:.9g},{:.9g}\n", tool_nodes + layer * tool_vertices + v + 1,
                          p.x(), p.y(), p.z());
    }
  }
  text += "*ELEMENT, TYPE=C3D6, ELSET=RIGID\n";
  for (std::size_t t = 0; t < deck.indenter.triangles.size(); ++t) {
    // Face 1-2-3 of C3D6 looks away from 4-5-6, so its corners run clockwise seen from the skin.
    const Triangle& c = deck.indenter.triangles[t];
    const Triangle run = {c[0], c[2], c[1]};
    text += fmt::format("{}", tool_elements + static_cast<int>(t) + 1);
    for (int layer = 0; layer < 2; ++layer) {
      for (const int v : run) {
        text += fmt::format(",{}", tool_nodes + layer * tool_vertices + v + 1);
      }
    }
    text += '\n';
  }

  append_node_set(text, "BONE", deck.block.on_bone);
  if (!deck.block.on_cut.empty()) append_node_set(text, "CUT", deck.block.on_cut);
  text += "*SURFACE, NAME=SKIN, TYPE=ELEMENT\n";
  for (const TetSide& s : deck.block.pressed) text += fmt::format("{},S{}\n", s.tet + 1, s.side);
  text += "*SURFACE, NAME=TOOL, TYPE=ELEMENT\n";
  for (std::size_t t = 0; t < deck.indenter.triangles.size(); ++t) {
    text += fmt::format("{},S1\n", tool_elements + static_cast<int>(t) + 1);
  }

  if (deck.material == DeckMaterial::kLinear) {
    text +=
        fmt::format("*MATERIAL, NAME=SOFT\n*ELASTIC\n{:.9g},{:.9g}\n", deck.young(), deck.poisson);
  } else {
    // U = C10 (I1 - 3) + (J - 1)^2 / D1 with C10 = G / 2, D1 = 2 / K.
    const double bulk = deck.young() / 3.0 / (1.0 - 2.0 * deck.poisson);
    text += fmt::format("*MATERIAL, NAME=SOFT\n*HYPERELASTIC, NEO HOOKE\n{:.9g},{:.9g}\n",
                        deck.shear_modulus / 2.0, 2.0 / bulk);
  }
  text += fmt::format(
      "*MATERIAL, NAME=STEEL\n*ELASTIC\n210000,0.3\n"
      "*SOLID SECTION, ELSET=TISSUE, MATERIAL=SOFT\n"
      "*SOLID SECTION, ELSET=RIGID, MATERIAL=STEEL\n"
      "*SURFACE INTERACTION, NAME=SMOOTH\n"
      "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{:.9g}\n"
      "*CONTACT PAIR, INTERACTION=SMOOTH, TYPE=SURFACE TO SURFACE\nSKIN,TOOL\n"
      "*BOUNDARY\nBONE,1,3\n",
      deck.penalty.value_or(kPenaltyPerYoung * deck.young()));
  if (deck.is_cut_held && !deck.block.on_cut.empty()) text += "CUT,1,3\n";
  const char* const geometry = deck.material == DeckMaterial::kLinear ? "" : ", NLGEOM";
  for (const double depth : deck.depths) {
    const Vec3 u = depth * deck.direction;
    text += fmt::format(
        "*STEP, INC=200{}\n*STATIC\n1,1,0.001,1\n"
        "*BOUNDARY\nINDENTER,1,1,{:.9g}\nINDENTER,2,2,{:.9g}\nINDENTER,3,3,{:.9g}\n"
        "*NODE PRINT, NSET=INDENTER, TOTALS=ONLY, FREQUENCY=1000\nRF\n"
        "*CONTACT PRINT, SLAVE=SKIN, MASTER=TOOL, FREQUENCY=1000\nCF\n"
        "*NODE FILE, FREQUENCY=1000\nU\n"
        "*CONTACT FILE, FREQUENCY=1000\nCDIS,CSTR\n*END STEP\n",
        geometry, u.x(), u.y(), u.z());
  }
  return text;
}

}  // namespace palmar::records
