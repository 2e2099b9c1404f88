// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/refine/divided_hand.h"

#include <map>
#include <utility>

#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/contact/refine/divided_compliance.h"

namespace palmar::contact {
namespace {

using Shares = std::vector<std::vector<std::pair<int, double>>>;

std::shared_ptr<const hand::Hand> with_skin(const hand::Hand& hand, const SkinDivision& division) {
  auto result = std::make_shared<hand::Hand>(hand);
  result->skin.vertices = division.at_rest();
  result->skin.triangles = division.triangles();
  for (const auto& [a, b] : division.ends()) {
    result->region.push_back(result->region[a]);
    if (!hand.segment.empty()) result->segment.push_back(result->segment[a]);
  }
  return result;
}

BoneTissueBlocks with_shares(const BoneTissueBlocks& blocks, const Shares& share) {
  BoneTissueBlocks result = blocks;
  for (std::size_t v = blocks.begin.size() - 1; v < share.size(); ++v) {
    std::map<int, double> sum;
    for (const auto& [parent, weight] : share[v]) {
      for (std::size_t k = blocks.begin[parent]; k < blocks.begin[parent + 1]; ++k) {
        sum[blocks.share[k].first] += weight * blocks.share[k].second;
      }
    }
    result.share.insert(result.share.end(), sum.begin(), sum.end());
    result.begin.push_back(result.share.size());
    for (std::size_t level = 0; level < result.g0.size(); ++level) {
      double g0 = 0.0;
      for (const auto& [block, weight] : sum) g0 += weight * blocks.block_g0[level][block];
      result.g0[level].push_back(g0);
    }
  }
  return result;
}

/// Of the skin before.
std::vector<double> told_areas(const PreparedHand::Impl& from, const Shares& share) {
  std::vector<double> result(share.size(), 0.0);
  for (std::size_t v = 0; v < share.size(); ++v) {
    for (const auto& [parent, weight] : share[v]) result[v] += weight * from.skin.area[parent];
  }
  return result;
}

}  // namespace

PreparedHand divided_hand(const PreparedHand& hand, const SkinDivision& division,
                          const std::vector<char>& wanted, bool with_meetings) {
  const PreparedHand::Impl& from = hand.impl();
  const std::shared_ptr<const hand::Hand> divided = with_skin(*from.hand, division);
  const Shares share = division.shares();
  if (!from.is_on_bone()) {
    auto impl = std::make_unique<PreparedHand::Impl>(PreparedHand(divided, from.model).impl());
    impl->told_area = told_areas(from, share);
    return PreparedHand(std::move(impl));
  }
  auto impl = std::make_unique<PreparedHand::Impl>();
  impl->hand = divided;
  impl->model = from.model;
  impl->skin = skin_geometry(divided->skin);
  impl->response = from.response;  // of skin off bone, which is not divided
  impl->response.begin.resize(share.size() + 1, from.response.begin.back());
  impl->compliance = std::make_shared<const SkinCompliance>(
      divided_compliance(*from.compliance, from.scale, from.skin, impl->skin, share, wanted));
  impl->bone = with_shares(from.bone, share);
  impl->told_area = told_areas(from, share);
  impl->set_patches();
  if (with_meetings) impl->meetings.emplace(*divided);
  return PreparedHand(std::move(impl));
}

}  // namespace palmar::contact
