// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "palmar/hand/template/template_hand.h"
#include "palmar/records/hand/hand_asset.h"

namespace palmar {

/// Tests on the template hand, built once from the package's asset; skipped where set-up has not
/// fetched it.
class TemplateTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(PALMAR_HAND_ASSET)) {
      GTEST_SKIP() << "the hand asset is not there (scripts/setup.sh fetches it): "
                   << PALMAR_HAND_ASSET;
    }
  }
  static const Hand& hand() {
    static const Hand built = build_template(read_hand_asset(PALMAR_HAND_ASSET));
    return built;
  }
};

}  // namespace palmar
