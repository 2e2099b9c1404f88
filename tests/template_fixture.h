// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "palmar/hand/template/template_hand.h"
#include "palmar/records/hand/hand_asset.h"

namespace palmar::tests {

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
  static const hand::Hand& hand() {
    static const hand::Hand built =
        hand::build_template(records::read_hand_asset(PALMAR_HAND_ASSET));
    return built;
  }
};

}  // namespace palmar::tests
