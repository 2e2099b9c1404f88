// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/tendon.h"

#include <array>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"

namespace palmar::hand {
namespace {

constexpr int kTendonCount = 14;

struct Naming {
  std::string_view name, anatomical;
};
constexpr std::array<Naming, kTendonCount> kNaming = {{{"fdp", "flexor digitorum profundus"},
                                                       {"fds", "flexor digitorum superficialis"},
                                                       {"edc", "extensor digitorum"},
                                                       {"lum", "lumbrical"},
                                                       {"ri", "radial interosseous"},
                                                       {"ui", "ulnar interosseous"},
                                                       {"fpl", "flexor pollicis longus"},
                                                       {"fpb", "flexor pollicis brevis"},
                                                       {"apb", "abductor pollicis brevis"},
                                                       {"opp", "opponens pollicis"},
                                                       {"adp", "adductor pollicis"},
                                                       {"epl", "extensor pollicis longus"},
                                                       {"epb", "extensor pollicis brevis"},
                                                       {"apl", "abductor pollicis longus"}}};

constexpr std::array<Tendon, 6> kFingerTendons = {Tendon::kFdp, Tendon::kFds, Tendon::kEdc,
                                                  Tendon::kLum, Tendon::kRi,  Tendon::kUi};
constexpr std::array<Tendon, 8> kThumbTendons = {Tendon::kFpl, Tendon::kFpb, Tendon::kApb,
                                                 Tendon::kOpp, Tendon::kAdp, Tendon::kEpl,
                                                 Tendon::kEpb, Tendon::kApl};

// cm^2. Index: EDC 0.52 and EIP 0.56; little finger: EDC 0.40 and EDM 0.64. Radial and ulnar
// interossei: DI1 and PI of the index, DI2 and DI3 of the middle, PI and DI4 of the ring, PI of the
// little finger and its abductor.
constexpr double kFingerCm2[4][6] = {{1.77, 1.71, 1.08, 0.11, 1.50, 0.75},
                                     {2.23, 2.53, 1.02, 0.08, 1.34, 0.95},
                                     {1.72, 1.61, 0.86, 0.08, 0.65, 0.91},
                                     {2.20, 0.40, 1.04, 0.06, 0.61, 0.89}};
constexpr double kThumbCm2[8] = {2.08, 0.66, 0.68, 1.02, 1.94, 0.98, 0.47, 1.93};
constexpr double kMm2PerCm2 = 100.0;

}  // namespace

std::span<const Tendon> tendons_of(Finger finger) {
  if (finger == Finger::kThumb) return kThumbTendons;
  return kFingerTendons;
}

std::string_view name_of(Tendon tendon) { return kNaming[index_of(tendon)].name; }

std::string_view anatomical_name_of(Tendon tendon) { return kNaming[index_of(tendon)].anatomical; }

std::optional<Tendon> tendon_named(std::string_view name) {
  for (int t = 0; t < kTendonCount; ++t) {
    if (kNaming[t].name == name) return static_cast<Tendon>(t);
  }
  return std::nullopt;
}

double cross_section_of(Finger finger, Tendon tendon) {
  const std::span<const Tendon> own = tendons_of(finger);
  for (std::size_t t = 0; t < own.size(); ++t) {
    if (own[t] != tendon) continue;
    if (finger == Finger::kThumb) return kThumbCm2[t] * kMm2PerCm2;
    return kFingerCm2[static_cast<int>(finger) - 1][t] * kMm2PerCm2;
  }
  throw Error(std::string(name_of(tendon)) + " is no tendon of the " +
              std::string(name_of(finger)));
}

}  // namespace palmar::hand
