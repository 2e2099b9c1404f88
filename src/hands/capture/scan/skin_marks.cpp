// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/skin_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <queue>

#include "hands/capture/picture_vectors.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

double linear(float coded) {
  const double c = coded;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// Chromaticity; that of grey for what is nearly black, whose colour is noise.
Vec2 chromaticity(const geometry::Srgb& colour) {
  constexpr double kBlack = 0.01;
  const double r = linear(colour[0]), g = linear(colour[1]), b = linear(colour[2]);
  return Vec2(r + kBlack / 3.0, g + kBlack / 3.0) / (r + g + b + kBlack);
}

double turn_between(const Vec2& a, const Vec2& b) {
  return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
}

constexpr double kWidestLine = 4.0;  // mm

constexpr std::array<const char*, 2> kInkName{"crease", "dot"};

struct Skin {
  Vec2 chroma = Vec2::Zero();
  double spread = 0.0;  ///< median distance of a vertex' chromaticity from it
};

/// Share of each of the two inks in every vertex.
std::array<std::vector<double>, 2> ink_shares(const std::vector<Vec2>& chroma, const Skin& skin,
                                              const SkinMarkOptions& options) {
  const std::array<Vec2, 2> way{chromaticity(options.crease) - skin.chroma,
                                chromaticity(options.dot) - skin.chroma};
  const double turn = options.largest_turn * std::numbers::pi / 180.0;
  const double clear = std::max(6.0 * skin.spread, 0.02);
  std::array<std::vector<double>, 2> share;
  std::array<std::vector<double>, 2> clearly;
  for (auto& s : share) s.assign(chroma.size(), 0.0);
  for (std::size_t v = 0; v < chroma.size(); ++v) {
    const Vec2 off = chroma[v] - skin.chroma;
    const std::array<double, 2> angle{turn_between(off, way[0]), turn_between(off, way[1])};
    const std::size_t ink = angle[0] <= angle[1] ? 0 : 1;
    if (angle[ink] > turn) continue;
    const double along = off.dot(way[ink].normalized());
    share[ink][v] = along;
    if (along > clear) clearly[ink].push_back(along);
  }
  for (std::size_t ink = 0; ink < 2; ++ink) {
    auto& c = clearly[ink];
    if (c.empty()) {
      std::fill(share[ink].begin(), share[ink].end(), 0.0);
      continue;
    }
    std::sort(c.begin(), c.end());
    const double full = c[c.size() * 9 / 10];
    for (double& s : share[ink]) s = s < clear ? 0.0 : std::min(1.0, s / full);
  }
  return share;
}

/// Connected vertices that fulfil `is_in`; in order of the smallest vertex.
std::vector<std::vector<int>> patches(const std::vector<std::vector<int>>& neighbours,
                                      const std::vector<char>& is_in) {
  std::vector<std::vector<int>> result;
  std::vector<char> is_seen(is_in.size(), 0);
  for (std::size_t v = 0; v < is_in.size(); ++v) {
    if (!is_in[v] || is_seen[v]) continue;
    std::vector<int> patch{static_cast<int>(v)};
    is_seen[v] = 1;
    for (std::size_t k = 0; k < patch.size(); ++k) {
      for (const int n : neighbours[patch[k]]) {
        if (!is_in[n] || is_seen[n]) continue;
        is_seen[n] = 1;
        patch.push_back(n);
      }
    }
    result.push_back(std::move(patch));
  }
  return result;
}

/// Whether a third of a patch lies farther from its rim, along its edges, than half a line's
/// greatest width does: a strap or a sleeve, no stroke of a pen.
bool is_band(const std::vector<int>& patch, const std::vector<char>& is_in,
             const geometry::TriangleMesh& mesh, const std::vector<std::vector<int>>& neighbours,
             const std::vector<double>& area) {
  std::map<int, double> depth;
  using Open = std::pair<double, int>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  for (const int v : patch) {
    const auto& around = neighbours[v];
    const bool is_rim = std::any_of(around.begin(), around.end(), [&](int n) { return !is_in[n]; });
    if (is_rim) open.emplace(0.0, v);
  }
  double whole = 0.0, deep = 0.0;
  while (!open.empty()) {
    const auto [at, v] = open.top();
    open.pop();
    if (!depth.emplace(v, at).second) continue;
    whole += area[v];
    if (at > 0.5 * kWidestLine) deep += area[v];
    for (const int n : neighbours[v]) {
      if (is_in[n]) open.emplace(at + (mesh.vertices[n] - mesh.vertices[v]).norm(), n);
    }
  }
  return deep > whole / 3.0;
}

/// What lies round a patch, counted from each of its vertices, and how much of that is a guess.
struct Rim {
  int all = 0, guesses = 0;
};
Rim rim_of(const std::vector<int>& patch, const std::vector<char>& is_in,
           const std::vector<std::vector<int>>& neighbours, const std::vector<char>& is_guess) {
  Rim rim;
  if (is_guess.empty()) return rim;
  for (const int v : patch) {
    for (const int n : neighbours[v]) {
      if (is_in[n]) continue;
      ++rim.all;
      if (is_guess[n]) ++rim.guesses;
    }
  }
  return rim;
}

void check_inks(const Skin& skin, const std::string& name, const SkinMarkOptions& options) {
  constexpr double kAlike = 0.05;
  const Vec2 crease = chromaticity(options.crease), dot = chromaticity(options.dot);
  const std::array<Vec2, 2> ink{crease, dot};
  for (std::size_t k = 0; k < 2; ++k) {
    if ((ink[k] - skin.chroma).norm() >= kAlike) continue;
    throw InputError(
        fmt::format("{}: the {} colour is like this skin's; marks in it can't be seen: "
                    "use an ink of another hue, and name its colour",
                    name, kInkName[k]));
  }
  if (turn_between(crease - skin.chroma, dot - skin.chroma) < 0.35) {
    throw InputError(fmt::format(
        "{}: crease and dot colours are too alike on this skin: one of them must differ "
        "in hue (green and blue do)",
        name));
  }
}

}  // namespace

void SkinMarkOptions::check() const {
  const auto hold = [](const char* field, double value, double least, double most) {
    if (!(value >= least && value <= most)) {
      throw UsageError(fmt::format("{} is {}; {} to {} is allowed", field, value, least, most));
    }
  };
  hold("least_share", least_share, 0.05, 0.95);
  hold("largest_turn", largest_turn, 5.0, 80.0);
  hold("dot_diameter", dot_diameter, 0.5, 10.0);
}

SkinMarks find_skin_marks(const geometry::ColouredMesh& mesh, const std::string& name,
                          const SkinMarkOptions& options) {
  options.check();
  if (mesh.colour.size() != mesh.mesh.vertices.size() || mesh.colour.empty()) {
    throw InputError(name + ": has no colours; creases and dots can't be seen");
  }
  SkinMarks marks;
  const auto is_guess = [&](std::size_t v) { return !mesh.is_guess.empty() && mesh.is_guess[v]; };
  std::vector<Vec2> chroma, seen;
  chroma.reserve(mesh.colour.size());
  std::array<std::vector<double>, 3> channel;
  for (std::size_t v = 0; v < mesh.colour.size(); ++v) {
    chroma.push_back(chromaticity(mesh.colour[v]));
    if (is_guess(v)) continue;
    seen.push_back(chroma.back());
    for (std::size_t k = 0; k < 3; ++k) channel[k].push_back(mesh.colour[v][static_cast<int>(k)]);
  }
  if (seen.empty()) throw InputError(name + ": no part of it was seen by any photograph");
  for (int k = 0; k < 3; ++k) marks.skin[k] = static_cast<float>(statistics::median(channel[k]));
  Skin skin;
  for (int k = 0; k < 2; ++k) {
    std::vector<double> part;
    for (const Vec2& c : seen) part.push_back(c[k]);
    skin.chroma[k] = statistics::median(std::move(part));
  }
  std::vector<double> off;
  for (const Vec2& c : seen) off.push_back((c - skin.chroma).norm());
  skin.spread = statistics::median(std::move(off));
  check_inks(skin, name, options);

  auto share = ink_shares(chroma, skin, options);
  for (auto& of_ink : share) {
    for (std::size_t v = 0; v < of_ink.size(); ++v) {
      if (is_guess(v)) of_ink[v] = 0.0;
    }
  }
  const geometry::MeshTopology topology = geometry::build_topology(mesh.mesh);
  const auto neighbours = geometry::vertex_neighbours(topology);
  const std::vector<double> area = geometry::vertex_areas(mesh.mesh);
  marks.is_ink.assign(chroma.size(), 0);
  for (std::size_t ink = 0; ink < 2; ++ink) {
    std::vector<char> is_in(chroma.size());
    for (std::size_t v = 0; v < is_in.size(); ++v) {
      is_in[v] = share[ink][v] >= options.least_share ? 1 : 0;
      if (is_in[v]) marks.is_ink[v] = 1;
    }
    // Of what lies round a dot, of a line and what lies round it may be a guess.
    constexpr double kRoundDot = 0.4, kOfLine = 0.6;
    const double dot_area = 0.25 * std::numbers::pi * options.dot_diameter * options.dot_diameter;
    int odd = 0, unseen = 0;
    double band = 0.0;  // mm^2
    for (const std::vector<int>& patch : patches(neighbours, is_in)) {
      const Rim rim = rim_of(patch, is_in, neighbours, mesh.is_guess);
      const double most =
          ink == 1 ? kRoundDot * rim.all : kOfLine * (rim.all + static_cast<double>(patch.size()));
      if (rim.guesses > most) {
        ++unseen;
        continue;
      }
      InkLine blot;
      Vec3 sum = Vec3::Zero();
      double weights = 0.0;
      for (const int v : patch) {
        const double w = area[v] * share[ink][v];
        blot.point.push_back(mesh.mesh.vertices[v]);
        blot.weight.push_back(w);
        blot.area += area[v];
        sum += w * blot.point.back();
        weights += w;
      }
      if (is_band(patch, is_in, mesh.mesh, neighbours, area)) {
        band += blot.area;
        for (const int v : patch) marks.is_ink[v] = 0;  // another colour
      } else if (ink == 1) {
        if (blot.area < dot_area / 3.0 || blot.area > 3.0 * dot_area) {
          ++odd;
        } else {
          marks.dots.push_back({sum / weights, blot.area, {}});
        }
      } else if (blot.area > 0.7) {
        marks.lines.push_back(std::move(blot));
      }
    }
    if (unseen > 0) {
      marks.notes.push_back(fmt::format(
          "{} blots in the {} colour end where no photograph saw the skin, as the backdrop's "
          "colour does, and are left out.",
          unseen, kInkName[ink] + std::string("s'")));
    }
    if (band > 0.0) {
      marks.notes.push_back(
          fmt::format("{:.0f} mm2 in the {} colour are wider than a drawn line ({:.0f} mm), as a "
                      "watch's strap, "
                      "a bracelet or a sleeve is, and are left out: take such things off, they "
                      "hide the wrist's "
                      "crease.",
                      band, kInkName[ink] + std::string("s'"), kWidestLine));
    }
    if (odd > 0) {
      marks.notes.push_back(fmt::format(
          "{} blots in the dots' colour are smaller than a third or larger than three times a dot "
          "of {:.3g} mm.",
          odd, options.dot_diameter));
    }
  }
  // Six times the skin's own spread, but no less than what light of another colour does.
  const double clear = std::max(6.0 * skin.spread, 0.06);
  constexpr double kLeastPatch = 20.0;  // mm^2
  std::vector<char> is_other(chroma.size());
  for (std::size_t v = 0; v < is_other.size(); ++v) {
    is_other[v] =
        !marks.is_ink[v] && !is_guess(v) && (chroma[v] - skin.chroma).norm() > clear ? 1 : 0;
  }
  for (std::vector<int>& patch : patches(neighbours, is_other)) {
    double size = 0.0;
    for (const int v : patch) size += area[v];
    if (size >= kLeastPatch) marks.other_colour.push_back(std::move(patch));
  }
  return marks;
}

}  // namespace palmar::capture
