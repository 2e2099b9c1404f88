// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "palmar/server/live_request.h"
#include "palmar/server/product_shelf.h"

namespace palmar::server {

// What the live channel answers as text: one JSON object per message. Keys carry units.

std::string dropped_answer(std::uint32_t request);
std::string progress_answer(std::uint32_t request, double share, const std::string& doing);
std::string error_answer(std::uint32_t request, const std::string& message, int code);

/// What was opened: product, hand with its angles and regions, ways to hold it
/// (ranked_holds_json()), and the colours of pictures.
std::string opened_answer(std::uint32_t request, const ShelvedProduct& product,
                          workflow::LiveSession& session, Language language);

/// A finished state: "assessment" as `palmar assess --json` prints it, the scale of pressures, and
/// the command line that gives the same figures; of a posture and placement that were set by hand
/// also the file that it reads ("posture_file", "posture").
std::string result_answer(const LiveRequest& request, const study::AssessmentSet& set,
                          Language language);

/// The command line that gives the figures of a request, "" if there is none: of a hand that closes
/// or comes to rest where the product was put by hand. `opened`: hand of the session; `own_hand`:
/// its file, "" if it is the template's or a person's by size.
std::string command_of(const LiveRequest& request, const LiveRequest& opened,
                       const ShelvedProduct& product, const std::string& own_hand = {});

/// Colours of pressure, skin and product: {"table": [[r, g, b], ...], "neutral", "skin",
/// "product"}.
std::string colours_json();

/// What is shown of a product on the shelf: {"key", "name", "file_name", "is_read", ...}.
std::string shelved_product_json(const ShelvedProduct& product);

}  // namespace palmar::server
