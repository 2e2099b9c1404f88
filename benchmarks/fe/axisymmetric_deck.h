// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace palmar::fe {

/// A sphere, rigid or with an elastic coating, pressed into a layer of tissue that is bonded to a
/// rigid base: an axisymmetric model of second-order quadrilaterals (CAX8R: reduced integration, so
/// that nearly incompressible tissue doesn't lock). Small strain, frictionless. mm, N, MPa.
struct SpherePress {
  double radius = 20.0;         ///< of the sphere, coating included
  double layer = 5.0;           ///< thickness of the tissue
  double width = 60.0;          ///< radius of the tissue; its side is free
  double shear_modulus = 0.01;  ///< of the tissue
  double poisson = 0.4999;
  std::optional<double> coating;  ///< thickness
  double coating_shear_modulus = 0.1;
  double coating_poisson = 0.4999;
  bool is_flat = false;        ///< a flat coated plate of radius `width` / 2 instead of a sphere
  std::vector<double> depths;  ///< of the sphere's core from first touch
  double fine_edge = 0.1;      ///< elements at the contact
  double fine_radius = 5.0;    ///< out to here
};

/// CalculiX deck. The driven nodes, the sphere or the core of a coated one, are the set INDENTER;
/// per step it prints their reaction: that of a sector of 2 degrees, the way CalculiX expands
/// axisymmetric models, so times kSectors for the whole.
inline constexpr double kSectors = 180.0;
std::string axisymmetric_deck(const SpherePress& press);

}  // namespace palmar::fe
