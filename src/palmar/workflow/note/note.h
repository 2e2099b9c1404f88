// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace palmar::workflow {

/// Takes a note that a user should see while a task runs: what was repaired, proposed or doubted.
using NoteSink = std::function<void(const std::string& text)>;

/// Gives a note to whoever listens; nobody is allowed.
inline void note_to(const NoteSink& sink, const std::string& text) {
  if (sink) sink(text);
}

}  // namespace palmar::workflow
