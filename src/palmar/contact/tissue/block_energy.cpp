// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/tissue/block_energy.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/enum_index.h"

namespace palmar::contact {
namespace {

constexpr double kMixedWidth = 6.0;  // mm; over which blocks mix, as laws do (stiffening.cpp)
constexpr std::array kLevels = {hand::TissueLevel::kLow, hand::TissueLevel::kNominal,
                                hand::TissueLevel::kHigh};

}  // namespace

BlockStiffening no_stiffening() {
  BlockStiffening lambda;
  lambda.fill(1.0);
  return lambda;
}

BoneTissueBlocks bone_tissue_blocks(const hand::Hand& hand, const SkinGeometry& skin,
                                    const std::array<double, hand::kRegionCount>& volume) {
  BoneTissueBlocks blocks;
  // Skin farther from a border than they mix is of one block.
  std::vector<int> at_border;
  std::vector<char> is_mixed(hand.region.size(), 0);
  for (int v = 0; v < skin.vertex_count(); ++v) {
    for (const int w : skin.neighbours(v)) {
      if (hand.region[w] == hand.region[v]) continue;
      at_border.push_back(v);
      break;
    }
  }
  for (const GrownVertex& g : grow(skin, at_border, kMixedWidth)) is_mixed[g.vertex] = 1;
  const auto count = static_cast<std::size_t>(skin.vertex_count());
  blocks.begin.push_back(0);
  for (std::size_t v = 0; v < count; ++v) {
    if (!is_mixed[v]) {
      blocks.share.emplace_back(static_cast<int>(index_of(hand.region[v])), 1.0);
      blocks.begin.push_back(blocks.share.size());
      continue;
    }
    const int source = static_cast<int>(v);
    std::array<double, hand::kRegionCount> weight{};
    double sum = 0.0;
    for (const GrownVertex& g : grow(skin, std::span(&source, 1), kMixedWidth)) {
      const double w = skin.area[g.vertex] * (1.0 - g.distance / kMixedWidth);
      weight[index_of(hand.region[g.vertex])] += w;
      sum += w;
    }
    for (std::size_t b = 0; b < weight.size(); ++b) {
      if (weight[b] > 0.0) blocks.share.emplace_back(static_cast<int>(b), weight[b] / sum);
    }
    blocks.begin.push_back(blocks.share.size());
  }
  for (const hand::TissueLevel level : kLevels) {
    const std::size_t l = index_of(level);
    for (std::size_t b = 0; b < volume.size(); ++b) {
      const hand::BoneTissueLaw& law = hand::law_at(hand.tissue.region[b].on_bone, level);
      blocks.block_g0[l][b] = law.g0;
      blocks.per_energy[l][b] =
          volume[b] > 0.0 ? law.stiffening * law.stiffening / (volume[b] * law.g0) : 0.0;
    }
    blocks.g0[l].assign(count, 0.0);
    for (std::size_t v = 0; v < count; ++v) {
      for (std::size_t k = blocks.begin[v]; k < blocks.begin[v + 1]; ++k) {
        blocks.g0[l][v] += blocks.share[k].second * blocks.block_g0[l][blocks.share[k].first];
      }
    }
  }
  return blocks;
}

BlockRoots::BlockRoots(const BlockStiffening& lambda) : inverse{} {
  for (std::size_t b = 0; b < lambda.size(); ++b) inverse[b] = 1.0 / std::sqrt(lambda[b]);
}

double root_modulus(const BoneTissueBlocks& blocks, hand::TissueLevel level,
                    const BlockRoots& roots, int vertex) {
  double sum = 0.0;
  for (std::size_t k = blocks.begin[vertex]; k < blocks.begin[vertex + 1]; ++k) {
    sum += blocks.share[k].second * roots.inverse[blocks.share[k].first];
  }
  return std::sqrt(blocks.g0[index_of(level)][vertex]) / sum;
}

BlockStiffening stiffening_of(const BoneTissueBlocks& blocks, hand::TissueLevel level,
                              const BlockStiffening& lambda, const std::vector<int>& vertex,
                              const std::vector<double>& force,
                              const std::vector<double>& displacement) {
  std::array<double, hand::kRegionCount> work{};
  const BlockRoots roots(lambda);
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    if (force[i] == 0.0) continue;
    const int v = vertex[i];
    // 1 / (tau sqrt(G0))
    const double scale =
        root_modulus(blocks, level, roots, v) / std::sqrt(blocks.g0[index_of(level)][v]);
    for (std::size_t k = blocks.begin[v]; k < blocks.begin[v + 1]; ++k) {
      work[blocks.share[k].first] += force[i] * displacement[i] * blocks.share[k].second * scale;
    }
  }
  BlockStiffening result = no_stiffening();
  for (std::size_t b = 0; b < result.size(); ++b) {
    const double energy = 0.5 * work[b] / (lambda[b] * std::sqrt(lambda[b]));
    const double K = blocks.per_energy[index_of(level)][b];
    result[b] = 1.0 + std::sqrt(K * std::max(energy, 0.0));
  }
  return result;
}

double stiffening_energy(const BoneTissueBlocks& blocks, hand::TissueLevel level,
                         const BlockStiffening& lambda) {
  double sum = 0.0;
  for (std::size_t b = 0; b < lambda.size(); ++b) {
    const double K = blocks.per_energy[index_of(level)][b];
    if (K > 0.0) sum += std::pow(lambda[b] - 1.0, 3) / (3.0 * K);
  }
  return sum;
}

}  // namespace palmar::contact
