// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/coarse_hand.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/contact/prepared/prepared_hand.h"

namespace palmar::contact {
namespace {

/// Shares of fine vertices in the area of those that take part with the vertex that stands for
/// them.
std::vector<float> shares(const SkinGeometry& skin, const hand::SkinSample& sample,
                          const std::vector<char>& takes_part) {
  std::vector<double> whole(sample.vertex.size(), 0.0);
  const auto counts = [&](std::size_t v) {
    return takes_part[v] == takes_part[static_cast<std::size_t>(sample.vertex[sample.entry[v]])];
  };
  for (std::size_t v = 0; v < sample.entry.size(); ++v) {
    if (counts(v)) whole[sample.entry[v]] += skin.area[v];
  }
  std::vector<float> result(sample.entry.size(), 0.0F);
  for (std::size_t v = 0; v < result.size(); ++v) {
    if (counts(v)) result[v] = static_cast<float>(skin.area[v] / whole[sample.entry[v]]);
  }
  return result;
}

std::vector<char> is_on_bone(const SkinCompliance& compliance, std::size_t vertices) {
  std::vector<char> result(vertices, 0);
  for (const int v : compliance.vertex) result[v] = 1;
  return result;
}

SkinCompliance averaged(const SkinCompliance& fine, const hand::SkinSample& sample,
                        const std::vector<float>& share) {
  SkinCompliance result;
  result.volume = fine.volume;
  const std::vector<char> on_bone = is_on_bone(fine, sample.entry.size());
  std::vector<int> row_of(sample.vertex.size(), -1);  // per coarse vertex
  for (std::size_t e = 0; e < sample.vertex.size(); ++e) {
    if (!on_bone[sample.vertex[e]]) continue;
    row_of[e] = static_cast<int>(result.vertex.size());
    result.vertex.push_back(static_cast<int>(e));
  }
  const auto coarse_row = [&](std::size_t row) { return row_of[sample.entry[fine.vertex[row]]]; };
  // Entries by the later of their two coarse rows.
  struct Entry {
    std::uint32_t row, place;
  };
  const std::size_t rows = result.vertex.size();
  std::vector<std::vector<Entry>> entries(rows);
  for (std::size_t i = 0; i < fine.vertex.size(); ++i) {
    if (share[fine.vertex[i]] == 0.0F) continue;
    const int a = coarse_row(i);
    for (std::size_t k = fine.begin[i]; k < fine.begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(fine.other[k]);
      if (share[fine.vertex[j]] == 0.0F) continue;
      entries[std::max(a, coarse_row(j))].push_back(
          {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k)});
    }
  }
  result.begin.push_back(0);
  std::vector<Eigen::Matrix3f> sum(rows, Eigen::Matrix3f::Zero());
  std::vector<char> is_met(rows, 0);
  std::vector<int> met;
  for (std::size_t a = 0; a < rows; ++a) {
    met.clear();
    for (const Entry& entry : entries[a]) {
      const auto j = static_cast<std::size_t>(fine.other[entry.place]);
      const auto own = static_cast<std::size_t>(coarse_row(entry.row));
      const auto other = static_cast<std::size_t>(coarse_row(j));
      const std::size_t b = std::min(own, other);
      if (!is_met[b]) {
        is_met[b] = 1;
        met.push_back(static_cast<int>(b));
      }
      const Eigen::Matrix3f part =
          share[fine.vertex[entry.row]] * share[fine.vertex[j]] * fine.tensor[entry.place];
      if (own == a) sum[b] += part;
      const bool is_both = own == other && entry.row != j;  // the other half isn't listed
      if (own != a || is_both) sum[b] += part.transpose();
    }
    std::sort(met.begin(), met.end());
    for (const int b : met) {
      result.other.push_back(b);
      result.tensor.push_back(sum[b]);
      sum[b].setZero();
      is_met[b] = 0;
    }
    result.begin.push_back(result.other.size());
  }
  return result;
}

/// Of skin off bone.
SkinResponse averaged(const SkinResponse& fine, const hand::SkinSample& sample,
                      const std::vector<float>& share, const std::vector<char>& on_bone) {
  SkinResponse result;
  const std::size_t count = sample.vertex.size();
  std::vector<std::vector<int>> members(count);
  for (std::size_t v = 0; v < sample.entry.size(); ++v) {
    if (!on_bone[v] && share[v] > 0.0F) members[sample.entry[v]].push_back(static_cast<int>(v));
  }
  result.begin.push_back(0);
  std::vector<float> sum(count, 0.0F);
  std::vector<char> is_met(count, 0);
  std::vector<int> met;
  for (std::size_t column = 0; column < count; ++column) {
    met.clear();
    for (const int v : members[column]) {
      for (std::size_t k = fine.begin[v]; k < fine.begin[v + 1]; ++k) {
        const int w = fine.vertex[k];
        if (on_bone[w] || share[w] == 0.0F) continue;
        const int row = sample.entry[w];
        if (!is_met[row]) {
          is_met[row] = 1;
          met.push_back(row);
        }
        sum[row] += share[v] * share[w] * fine.response[k];
      }
    }
    std::sort(met.begin(), met.end());
    for (const int row : met) {
      result.vertex.push_back(row);
      result.response.push_back(sum[row]);
      sum[row] = 0.0F;
      is_met[row] = 0;
    }
    result.begin.push_back(result.vertex.size());
  }
  result.distance.assign(result.vertex.size(), 0.0F);
  return result;
}

BoneTissueBlocks part_of(const BoneTissueBlocks& blocks, const std::vector<int>& vertices) {
  BoneTissueBlocks result;
  result.block_g0 = blocks.block_g0;
  result.per_energy = blocks.per_energy;
  result.begin.push_back(0);
  for (const int v : vertices) {
    const auto first = blocks.share.begin();
    result.share.insert(result.share.end(), first + static_cast<std::ptrdiff_t>(blocks.begin[v]),
                        first + static_cast<std::ptrdiff_t>(blocks.begin[v + 1]));
    result.begin.push_back(result.share.size());
    for (std::size_t level = 0; level < result.g0.size(); ++level) {
      result.g0[level].push_back(blocks.g0[level][v]);
    }
  }
  return result;
}

/// The hand with the vertices of the sample alone; triangles where three neighbourhoods meet.
hand::Hand with_coarse_skin(const hand::Hand& hand, const hand::SkinSample& sample) {
  hand::Hand result;
  result.name = hand.name;
  result.side = hand.side;
  result.skeleton = hand.skeleton;
  result.dimensions = hand.dimensions;
  result.tissue = hand.tissue;
  std::vector<int> place(hand.skin.vertices.size(), -1);
  for (std::size_t e = 0; e < sample.vertex.size(); ++e) {
    const int v = sample.vertex[e];
    place[v] = static_cast<int>(e);
    result.skin.vertices.push_back(hand.skin.vertices[v]);
    if (!hand.segment.empty()) result.segment.push_back(hand.segment[v]);
    result.region.push_back(hand.region[v]);
  }
  for (const Triangle& t : hand.skin.triangles) {
    Triangle meeting;
    for (std::size_t k = 0; k < 3; ++k) meeting[k] = sample.entry[t[k]];
    if (meeting[0] == meeting[1] || meeting[1] == meeting[2] || meeting[2] == meeting[0]) continue;
    std::rotate(meeting.begin(), std::min_element(meeting.begin(), meeting.end()), meeting.end());
    result.skin.triangles.push_back(meeting);
  }
  std::sort(result.skin.triangles.begin(), result.skin.triangles.end());
  result.skin.triangles.erase(
      std::unique(result.skin.triangles.begin(), result.skin.triangles.end()),
      result.skin.triangles.end());
  for (const hand::JointWeights& fine : hand.weights) {
    hand::JointWeights& weights = result.weights.emplace_back();
    weights.joint = fine.joint;
    for (std::size_t k = 0; k < fine.vertex.size(); ++k) {
      const int at = place[fine.vertex[k]];
      if (at < 0) continue;
      weights.vertex.push_back(at);
      weights.w1.push_back(fine.w1[k]);
      weights.w2.push_back(fine.w2[k]);
      if (!fine.bulge.empty()) weights.bulge.push_back(fine.bulge[k]);
    }
  }
  result.thumb_ball = hand.thumb_ball;
  result.thumb_ball.vertex.clear();
  for (const int v : hand.thumb_ball.vertex) {
    if (place[v] >= 0) result.thumb_ball.vertex.push_back(place[v]);
  }
  return result;
}

}  // namespace

CoarseSkin coarse_skin(const hand::Hand& hand, const SkinGeometry& skin,
                       const SkinCompliance* compliance) {
  CoarseSkin result;
  result.sample = hand::sample_skin(hand, kCoarseSpacing);
  if (compliance != nullptr) {
    const auto share =
        shares(skin, result.sample, is_on_bone(*compliance, result.sample.entry.size()));
    result.compliance =
        std::make_shared<const SkinCompliance>(averaged(*compliance, result.sample, share));
  }
  return result;
}

CoarseHand coarse_hand(const PreparedHand::Impl& hand, const CoarseSkin& skin) {
  const hand::SkinSample& sample = skin.sample;
  auto coarse = std::make_shared<const hand::Hand>(with_coarse_skin(*hand.hand, sample));
  if (!hand.is_on_bone()) return {sample, PreparedHand(coarse, hand.model)};
  auto impl = std::make_unique<PreparedHand::Impl>();
  impl->model = hand.model;
  impl->skin = skin_geometry(coarse->skin);
  impl->hand = std::move(coarse);
  impl->compliance = skin.compliance;
  if (!hand.scale.empty()) {
    for (const int v : sample.vertex) impl->scale.push_back(hand.scale[v]);
  }
  impl->bone = part_of(hand.bone, sample.vertex);
  const std::vector<char> on_bone = is_on_bone(*hand.compliance, sample.entry.size());
  impl->response = averaged(hand.response, sample, shares(hand.skin, sample, on_bone), on_bone);
  impl->set_patches();
  return {sample, PreparedHand(std::move(impl))};
}

}  // namespace palmar::contact
