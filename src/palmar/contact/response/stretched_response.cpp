// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "palmar/contact/response/pair_response.h"
#include "palmar/contact/response/response.h"
#include "palmar/contact/response/skin_response.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/parallel.h"
#include "palmar/core/processor.h"

namespace palmar::contact {
namespace {

constexpr int kBlock = 64;  // columns

// The same operations in the same order with and without vector instructions, so the answer doesn't
// depend on the processor.

/// Functions of one number in single precision, by straight lines between equal steps.
template <int kSize>
struct Table {
  std::array<float, kSize + 2> value;
  template <typename Function>
  Table(double step, const Function& function) : value{} {
    for (std::size_t i = 0; i < value.size(); ++i) {
      value[i] = static_cast<float>(function(step * static_cast<double>(i)));
    }
  }
};

/// ((phi/2)^2 / sin^2(phi/2) - 1) / t2 over sin^2(phi/2) = t2 / 4; see arc_distance(). Off by less
/// than 1e-5 of the distance where normals turn by less than 170 degrees.
constexpr int kTurns = 2048;
const Table<kTurns>& turn_table() {
  static const Table<kTurns> table(1.0 / kTurns, [](double sine2) {
    if (sine2 < 1e-12) return 1.0 / 12.0;
    const double sine = std::sqrt(std::min(1.0, sine2));
    const double stretch = std::asin(sine) / sine;
    return (stretch * stretch - 1.0) / (4.0 * sine2);
  });
  return table;
}

/// disc_response() of the unit disc up to kDiscEnd radii; its series beyond.
constexpr int kDiscEnd = 6, kPerRadius = 1024;
const Table<kDiscEnd * kPerRadius>& disc_table() {
  static const Table<kDiscEnd * kPerRadius> table(
      1.0 / kPerRadius, [](double rho) { return disc_response(rho, 1.0); });
  return table;
}

/// Positions and normals of a skin, coordinate by coordinate, and one over its vertices' radii.
struct SkinLines {
  explicit SkinLines(const SkinGeometry& skin) {
    for (std::size_t v = 0; v < skin.position.size(); ++v) {
      for (std::size_t c = 0; c < 3; ++c) {
        position[c].push_back(static_cast<float>(skin.position[v][static_cast<Eigen::Index>(c)]));
        normal[c].push_back(static_cast<float>(skin.normal[v][static_cast<Eigen::Index>(c)]));
      }
      inverse_radius.push_back(static_cast<float>(1.0 / skin.radius[v]));
    }
  }
  std::array<std::vector<float>, 3> position, normal;
  std::vector<float> inverse_radius;
};

/// r[k] = detour[k] times the arc from vertex j to vertex[k], mm.
__attribute__((always_inline)) inline void distances(const SkinLines& skin, std::size_t j,
                                                     const std::int32_t* vertex,
                                                     const float* detour, int count, float* r) {
  const float *px = skin.position[0].data(), *py = skin.position[1].data(),
              *pz = skin.position[2].data(), *nx = skin.normal[0].data(),
              *ny = skin.normal[1].data(), *nz = skin.normal[2].data();
  const float* table = turn_table().value.data();
  const float jx = px[j], jy = py[j], jz = pz[j], jnx = nx[j], jny = ny[j], jnz = nz[j];
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const std::int32_t i = vertex[k];
    const float cx = px[i] - jx, cy = py[i] - jy, cz = pz[i] - jz;
    const float tx = nx[i] - jnx, ty = ny[i] - jny, tz = nz[i] - jnz;
    const float along = cx * tx + cy * ty + cz * tz;
    const float turn2 = tx * tx + ty * ty + tz * tz;
    const float x = turn2 * (0.25F * kTurns);  // at most kTurns, but for rounding
    const auto at = static_cast<std::int32_t>(x);
    const float share = x - static_cast<float>(at);
    const float q = table[at] + share * (table[at + 1] - table[at]);
    r[k] = detour[k] * std::sqrt(cx * cx + cy * cy + cz * cz + along * along * q);
  }
}

/// disc_response(r, a) from 1 / a. Choices by factors: eight at a time.
__attribute__((always_inline)) inline float disc(const float* table, float r, float inverse_a) {
  constexpr std::int32_t kEnd = kDiscEnd * kPerRadius;
  const float rho = r * inverse_a;
  const float x = rho * kPerRadius;
  const auto all = static_cast<std::int32_t>(x);
  const std::int32_t at = all < kEnd ? all : kEnd;
  const float near = table[at] + (x - static_cast<float>(at)) * (table[at + 1] - table[at]);
  const float inverse = 1.0F / (rho + 1e-6F);
  const float k2 = inverse * inverse;
  const float far = (1.0F + k2 * (0.125F + k2 * (3.0F / 64.0F))) *
                    (static_cast<float>(0.25 / std::numbers::pi) * inverse);
  const auto is_near = static_cast<float>(static_cast<std::int32_t>(all < kEnd));  // 0 or 1
  return (is_near * near + (1.0F - is_near) * far) * inverse_a;
}

/// PairResponse of a half-space with coupled regions: mean of the discs, faded out.
__attribute__((always_inline)) inline void responses(const SkinLines& skin, std::size_t j,
                                                     const std::int32_t* vertex, const float* r,
                                                     int count, float* response) {
  const float* inverse = skin.inverse_radius.data();
  const float* table = disc_table().value.data();
  const float own = inverse[j];
  constexpr auto kPerReach = static_cast<float>(1.0 / kResponseReach);
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const float falling = 3.0F * (1.0F - r[k] * kPerReach);
    const auto is_full = static_cast<float>(static_cast<std::int32_t>(falling >= 1.0F));
    const float t = is_full + (1.0F - is_full) * falling;
    const float both = disc(table, r[k], inverse[vertex[k]]) + disc(table, r[k], own);
    response[k] = t * t * (3.0F - 2.0F * t) * (0.5F * both);
  }
}

PALMAR_AVX2 void distances_avx2(const SkinLines& skin, std::size_t j, const std::int32_t* vertex,
                                const float* detour, int count, float* r) {
  distances(skin, j, vertex, detour, count, r);
}
void distances_any(const SkinLines& skin, std::size_t j, const std::int32_t* vertex,
                   const float* detour, int count, float* r) {
  distances(skin, j, vertex, detour, count, r);
}
PALMAR_AVX2 void responses_avx2(const SkinLines& skin, std::size_t j, const std::int32_t* vertex,
                                const float* r, int count, float* response) {
  responses(skin, j, vertex, r, count, response);
}
void responses_any(const SkinLines& skin, std::size_t j, const std::int32_t* vertex, const float* r,
                   int count, float* response) {
  responses(skin, j, vertex, r, count, response);
}

/// Up to which distance a response is wanted, mm.
class Reach {
 public:
  Reach(const hand::Hand& hand, const ContactModel& model) : hand_(&hand), model_(model) {}
  float operator()(int i, int j) const {
    if (model_.coupling == RegionCoupling::kCoupled) return static_cast<float>(kResponseReach);
    const hand::Region own = hand_->region[j];
    if (hand_->region[i] == own) {
      return own == hand::Region::kDorsum ? static_cast<float>(kResponseReach) : 1e6F;
    }
    return static_cast<float>(hand_->tissue.region[index_of(own)].neighbourhood);
  }

 private:
  const hand::Hand* hand_;
  ContactModel model_;
};

}  // namespace

SkinResponse stretched_response(const hand::Hand& hand, const SkinGeometry& skin,
                                const ContactModel& model, const std::vector<double>& thickness,
                                const SkinPairs& pairs) {
  const SkinLines lines(skin);
  const PairResponse response(hand, skin, model, thickness);
  const Reach reach(hand, model);
  const bool is_coupled = model.coupling == RegionCoupling::kCoupled;
  const bool is_usual =
      is_coupled && model.tissue != TissueModel::kLayered && model.kernel == Kernel::kPatch;
  const auto find_distances = has_avx2() ? distances_avx2 : distances_any;
  const auto find_responses = has_avx2() ? responses_avx2 : responses_any;
  const int count = skin.vertex_count();
  const int blocks = (count + kBlock - 1) / kBlock;
  // Calls visit(column, vertices, distances, number) with the pairs of each column in reach.
  const auto for_columns = [&](int block, const auto& visit) {
    std::vector<std::int32_t> vertex;
    std::vector<float> r;
    for (int j = block * kBlock; j < std::min(count, (block + 1) * kBlock); ++j) {
      const std::size_t first = pairs.begin[j];
      const std::size_t number = pairs.begin[j + 1] - first;
      vertex.resize(number);
      r.resize(number);
      find_distances(lines, j, pairs.vertex.data() + first, pairs.detour.data() + first,
                     static_cast<int>(number), r.data());
      std::size_t kept = 0;
      constexpr auto kReach = static_cast<float>(kResponseReach);
      for (std::size_t k = 0; k < number; ++k) {
        // Written in any case, kept only if near enough: no branch.
        vertex[kept] = pairs.vertex[first + k];
        r[kept] = r[k];
        kept += r[k] <= (is_coupled ? kReach : reach(vertex[kept], j)) ? 1 : 0;
      }
      visit(j, vertex.data(), r.data(), kept);
    }
  };
  SkinResponse result;
  result.begin.assign(static_cast<std::size_t>(count) + 1, 0);
  parallel_for(blocks, [&](int block) {
    for_columns(block, [&](std::size_t column, const std::int32_t*, const float*,
                           std::size_t kept) { result.begin[column + 1] = kept; });
  });
  for (std::size_t j = 0; j < static_cast<std::size_t>(count); ++j) {
    result.begin[j + 1] += result.begin[j];
  }
  result.vertex.resize(result.begin.back());
  result.response.resize(result.begin.back());
  result.distance.resize(result.begin.back());
  parallel_for(blocks, [&](int block) {
    for_columns(block, [&](std::size_t column, const std::int32_t* vertex, const float* r,
                           std::size_t kept) {
      const std::size_t first = result.begin[column];
      std::copy(vertex, vertex + kept, result.vertex.data() + first);
      std::copy(r, r + kept, result.distance.data() + first);
      float* to = result.response.data() + first;
      if (is_usual) {
        find_responses(lines, column, vertex, r, static_cast<int>(kept), to);
        return;
      }
      for (std::size_t k = 0; k < kept; ++k) {
        to[k] = response(vertex[k], static_cast<int>(column), static_cast<double>(r[k]));
      }
    });
  });
  return result;
}

}  // namespace palmar::contact
