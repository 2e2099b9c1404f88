// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/contact/pair_response.h"
#include "palmar/contact/skin_response.h"
#include "palmar/core/parallel.h"

namespace palmar {
namespace {

constexpr int kBlock = 64;  // columns

/// ((phi/2)^2 / sin^2(phi/2) - 1) / t2 over t2 = 4 sin^2(phi/2) (see arc_distance()), tabulated:
/// off by less than 1e-5 of the distance where normals turn by less than 170 degrees.
class ArcTable {
 public:
  ArcTable() {
    for (int i = 0; i <= kSize; ++i) {
      const double sine = std::sqrt(static_cast<double>(i) / kSize);
      const double stretch = sine > 0.0 ? std::asin(sine) / sine : 1.0;
      value_[static_cast<std::size_t>(i)] =
          i == 0 ? 1.0F / 12.0F
                 : static_cast<float>((stretch * stretch - 1.0) / (4.0 * sine * sine));
    }
    value_[kSize + 1] = value_[kSize];
  }
  float operator()(float turn2) const {
    const float x = std::min(turn2 * (0.25F * kSize), static_cast<float>(kSize));
    const int i = static_cast<int>(x);
    const auto k = static_cast<std::size_t>(i);
    return value_[k] + (x - static_cast<float>(i)) * (value_[k + 1] - value_[k]);
  }

 private:
  static constexpr int kSize = 2048;
  std::array<float, kSize + 2> value_{};
};

struct Spot {
  float x, y, z, nx, ny, nz;
};

float arc_between(const Spot& a, const Spot& b, const ArcTable& table) {
  const float cx = b.x - a.x, cy = b.y - a.y, cz = b.z - a.z;
  const float tx = b.nx - a.nx, ty = b.ny - a.ny, tz = b.nz - a.nz;
  const float along = cx * tx + cy * ty + cz * tz;
  return std::sqrt(cx * cx + cy * cy + cz * cz +
                   along * along * table(tx * tx + ty * ty + tz * tz));
}

/// Up to which distance a response is wanted, mm.
class Reach {
 public:
  Reach(const Hand& hand, const ContactModel& model) : hand_(&hand), model_(model) {}
  float operator()(int i, int j) const {
    if (model_.coupling == RegionCoupling::kCoupled) return static_cast<float>(kResponseReach);
    const Region own = hand_->region[static_cast<std::size_t>(j)];
    if (hand_->region[static_cast<std::size_t>(i)] == own) {
      return own == Region::kDorsum ? static_cast<float>(kResponseReach) : 1e6F;
    }
    return static_cast<float>(hand_->tissue.region[static_cast<std::size_t>(own)].neighbourhood);
  }

 private:
  const Hand* hand_;
  ContactModel model_;
};

}  // namespace

SkinResponse stretched_response(const Hand& hand, const SkinGeometry& skin,
                                const ContactModel& model, const std::vector<double>& thickness,
                                const SkinPairs& pairs) {
  static const ArcTable table;
  const PairResponse response(hand, skin, model, thickness);
  const Reach reach(hand, model);
  const int count = skin.vertex_count();
  std::vector<Spot> spot(static_cast<std::size_t>(count));
  for (std::size_t v = 0; v < spot.size(); ++v) {
    const Eigen::Vector3f p = skin.position[v].cast<float>(), n = skin.normal[v].cast<float>();
    spot[v] = {p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
  }
  // Room for all pairs; what lies farther apart than needed is left out when the blocks are joined.
  SkinResponse result;
  result.begin.assign(static_cast<std::size_t>(count) + 1, 0);
  const int blocks = (count + kBlock - 1) / kBlock;
  struct Part {
    std::vector<std::int32_t> vertex;
    std::vector<float> response, distance;
  };
  std::vector<Part> parts(static_cast<std::size_t>(blocks));
  parallel_for(blocks, [&](int block) {
    Part& part = parts[static_cast<std::size_t>(block)];
    const int last = std::min(count, (block + 1) * kBlock);
    const std::size_t most = pairs.begin[static_cast<std::size_t>(last)] -
                             pairs.begin[static_cast<std::size_t>(block * kBlock)];
    part.vertex.reserve(most);
    part.response.reserve(most);
    part.distance.reserve(most);
    for (int j = block * kBlock; j < last; ++j) {
      const auto column = static_cast<std::size_t>(j);
      const std::size_t before = part.vertex.size();
      for (std::size_t k = pairs.begin[column]; k < pairs.begin[column + 1]; ++k) {
        const int i = pairs.vertex[k];
        const float r = i == j ? 0.0F
                               : pairs.detour[k] * arc_between(spot[static_cast<std::size_t>(i)],
                                                               spot[column], table);
        if (r > reach(i, j)) continue;
        part.vertex.push_back(i);
        part.distance.push_back(r);
        part.response.push_back(response(i, j, static_cast<double>(r)));
      }
      result.begin[column + 1] = part.vertex.size() - before;
    }
  });
  for (std::size_t j = 0; j < static_cast<std::size_t>(count); ++j) {
    result.begin[j + 1] += result.begin[j];
  }
  result.vertex.resize(result.begin.back());
  result.response.resize(result.begin.back());
  result.distance.resize(result.begin.back());
  parallel_for(blocks, [&](int block) {
    const Part& part = parts[static_cast<std::size_t>(block)];
    const auto at =
        static_cast<std::ptrdiff_t>(result.begin[static_cast<std::size_t>(block * kBlock)]);
    std::copy(part.vertex.begin(), part.vertex.end(), result.vertex.begin() + at);
    std::copy(part.response.begin(), part.response.end(), result.response.begin() + at);
    std::copy(part.distance.begin(), part.distance.end(), result.distance.begin() + at);
  });
  return result;
}

}  // namespace palmar
