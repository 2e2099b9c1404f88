// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/contact/press/press.h"
#include "palmar/workflow/words/contact_words.h"

namespace palmar::workflow {

/// plane | ellipsoid:RX,RY | HAND:REGION; sets `hand` for the last. Throws UsageError.
contact::PressSpecimen parse_specimen(const std::string& text, std::string& hand);

/// sphere:R | punch:A | punches:A,DISTANCE | cylinder:R | plane. Throws UsageError.
contact::PressIndenter parse_indenter(const std::string& text);

/// "low", "nominal", "high". Throws UsageError.
hand::TissueLevel parse_tissue_level(const std::string& text);

/// The equations of an indentation test: a hand's as they are named, of a plane or ellipsoid a
/// half-space, or a layer where `layer` [mm] says how thick. Throws UsageError.
contact::ContactModel press_model(const ContactModelWords& words, std::optional<double> layer,
                                  bool is_hand);

/// Cover of an indenter: parse_coating() without a box. Throws UsageError.
contact::Coating parse_cover(const std::string& text);

}  // namespace palmar::workflow
