// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palmar/contact/contact.h"

namespace palmar::contact {

/// How the posed skin lies to the product before contact.
struct SkinOnProduct {
  std::vector<Vec3> normal;                      ///< of the posed skin, outward, product frame
  std::vector<geometry::DistanceSample> sample;  ///< per vertex; capped at 6 mm outside
  std::vector<Vec3> facing;    ///< per vertex near the product, its smooth_normal()
  std::vector<int> near;       ///< vertices that were sampled, ascending
  std::vector<int> collision;  ///< penetrating vertices that take part, ascending
  std::vector<int> left_out;   ///< penetrating vertices without a surface to go to, or too
                               ///< deep; ascending
  std::vector<int> traced;     ///< collision vertices whose `sample` isn't the nearest point
                               ///< but the one the skin came through, ascending
  bool is_too_deep = false;    ///< palmar skin deeper than kMaxContactDepth
  std::string message;         ///< what was left out, or empty

  /// Of a posed skin nothing is known but its normals.
  void begin(const hand::Hand& hand, const std::vector<Vec3>& posed);
};

/// Skin farther from the product than this does not matter; beyond the limit depth of the fingers
/// and every bulge.
constexpr double kNearRange = 6.0;  // mm

/// Memory of where a hand's skin was when it was last sampled, for motions. A distance changes by
/// no more than the way a vertex has gone, so skin that was far is still too far without a
/// question; the others start from what was nearest. The samples are those without it.
class SkinSampler {
 public:
  void clear() { product_ = 0; }

 private:
  friend void find_skin_on_product(const hand::Hand&, const std::vector<Vec3>&,
                                   const geometry::DistanceField&, std::optional<hand::Region>,
                                   SkinSampler*, SkinOnProduct&, double);
  void sample(const geometry::DistanceField& product, const std::vector<Vec3>& posed,
              const std::vector<Vec3>& normal, const std::vector<int>& near, double wanted,
              std::vector<geometry::DistanceSample>& samples);

  std::uint64_t product_ = 0;                     // id of the field the rest is about; 0: none
  std::vector<Vec3> position_;                    // where a vertex was last sampled
  std::vector<geometry::DistanceSample> sample_;  // what the field said there
  std::vector<char> is_known_;
  std::vector<int> asked_;
  std::vector<Vec3> points_;
  std::vector<geometry::DistanceSample> found_;
};

/// Skin whose flesh is right through a thin product (a card between thumb and finger): the surface
/// it came through, found from `flesh` [mm] under the skin outwards; distance is how far it is
/// behind that, negative. `nearest`: the product's sample at the point. Nothing where no product
/// lies in there or where it begins inside it.
std::optional<geometry::DistanceSample> surface_passed(const geometry::DistanceField& product,
                                                       const Vec3& point,
                                                       const geometry::DistanceSample& nearest,
                                                       const Vec3& skin_normal, double flesh);

/// Flesh that a thin product may be pressed into without having come from the finger's other side,
/// mm: half a finger's thickness, at most 7.
double flesh_depth(const hand::Hand& hand);

/// Samples the product near the skin and decides for each penetrating vertex to which side of the
/// product it belongs (see solve_hand_contact()).
SkinOnProduct find_skin_on_product(const hand::Hand& hand, const std::vector<Vec3>& posed,
                                   const geometry::DistanceField& product,
                                   std::optional<hand::Region> only);

/// The same into `skin`, whose memory is reused, with a sampler (or none) kept from call to call.
/// With one, skin farther outside than `wanted` [mm] may be reported as if it were kNearRange away.
void find_skin_on_product(const hand::Hand& hand, const std::vector<Vec3>& posed,
                          const geometry::DistanceField& product, std::optional<hand::Region> only,
                          SkinSampler* sampler, SkinOnProduct& skin, double wanted = kNearRange);

/// Samples the product at some vertices into their places in `samples`.
void sample_vertices(const geometry::DistanceField& product, const std::vector<Vec3>& positions,
                     const std::vector<int>& vertices, double range,
                     std::vector<geometry::DistanceSample>& samples);

/// The same for vertices that have moved a little; `samples` holds what they had before (see
/// DistanceField::resample()).
void resample_vertices(const geometry::DistanceField& product, const std::vector<Vec3>& positions,
                       const std::vector<int>& vertices, double range,
                       std::vector<geometry::DistanceSample>& samples);

}  // namespace palmar::contact
