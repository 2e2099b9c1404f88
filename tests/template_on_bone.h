// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/records/hand/compliance_file.h"
#include "palmar/records/hand/hand_file.h"

namespace palmar::tests {

/// The built-in hand with its tissue on bone, as the program holds with it.
inline const contact::PreparedHand& hand_on_bone() {
  static const contact::PreparedHand made = [] {
    const std::string share = PALMAR_SHARE;
    const auto hand =
        std::make_shared<const hand::Hand>(records::read_hand(share + "/template.hand.glb"));
    auto compliance = records::read_compliance(share + "/template.compliance",
                                               records::compliance_key(*hand), *hand);
    return contact::PreparedHand(
        hand, contact::palmar_model(),
        std::make_shared<const contact::SkinCompliance>(std::move(compliance.value())));
  }();
  return made;
}

}  // namespace palmar::tests
