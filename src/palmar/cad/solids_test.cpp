// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/solids.h"

#include <gmock/gmock.h>

#include <BRepBndLib.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <cmath>
#include <numbers>

#include "palmar/cad/occt_model.h"
#include "palmar/core/error.h"
#include "palmar/core/random.h"

namespace palmar {
namespace {

constexpr double kPi = std::numbers::pi;

CadModel make(const std::string& kind,
              const std::vector<std::pair<std::string, double>>& given = {}) {
  const ParametricKind& known = parametric_kind(kind);
  return make_kind_solid(known, complete_values(known, given));
}

double volume_of(const CadModel& model) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(model.impl().shape, properties, 1e-6);
  return properties.Mass();
}

TEST(Smoke, Defaults) {
  for (const ParametricKind& kind : parametric_kinds()) {
    const CadModel model = make(kind.name);
    std::printf("%s: volume %.3f, faces %d, named %zu\n", kind.name.c_str(), volume_of(model),
                model.face_count(), model.impl().face_name.size());
    for (const auto& [number, name] : model.impl().face_name) {
      std::printf("  %d %s\n", number, name.c_str());
    }
  }
}

/// Random values of a kind within ranges; relations by rejection.
KindValues random_values(const ParametricKind& kind, RandomStream& random) {
  const auto share = [](RandomStream& stream) { return stream.uniform(); };
  for (int attempt = 0;; ++attempt) {
    std::vector<std::pair<std::string, double>> given;
    for (const KindParameter& one : kind.parameters) {
      double value = 0.0;
      if (one.lowest > 0.0 && one.highest > 100.0 * one.lowest) {
        value = one.lowest * std::pow(one.highest / one.lowest, share(random));
      } else if (one.lowest == 0.0 && one.highest > 100.0) {
        value = std::pow(one.highest + 1.0, share(random)) - 1.0;
      } else {
        value = one.lowest + (one.highest - one.lowest) * share(random);
      }
      if (one.lowest == 0.0 && share(random) < 0.2) value = 0.0;
      if (one.is_whole) value = std::round(value);
      given.emplace_back(one.name, value);
    }
    try {
      return complete_values(kind, given);
    } catch (const UsageError&) {
      if (attempt > 200000) throw;
    }
  }
}

TEST(KindSolids, AreValidClosedAndInsideTheirBoxOverTheWholeRange) {
  for (const ParametricKind& kind : parametric_kinds()) {
    if (std::getenv("KIND") && kind.name != std::getenv("KIND")) continue;
    RandomStream random(6, 0);
    int failed = 0;
    for (int i = 0; i < 200; ++i) {
      const KindValues values = random_values(kind, random);
      try {
        const CadModel model = make_kind_solid(kind, values);
      } catch (const NumericalError& error) {
        if (++failed < 5) ADD_FAILURE() << error.what();
      }
    }
    std::printf("%s failed %d\n", kind.name.c_str(), failed);
  }
}

}  // namespace
}  // namespace palmar
