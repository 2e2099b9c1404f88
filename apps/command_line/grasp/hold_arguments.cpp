// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "grasp/hold_arguments.h"

namespace palmar::cli {
void HoldArguments::add_hold_to(CLI::App& verb) {
  verb.add_option("--hold", words_.hold,
                  "How to hold the product: a hold's file (.toml), or its number in the list of "
                  "palmar grasp holds; the first that comes to rest if nothing is said");
}

void HoldArguments::add_to(CLI::App& verb) {
  verb.add_option("--part", words_.part,
                  "Hold this part of the product: its name or number (palmar product parts)");
  verb.add_option("--along", words_.along,
                  "Where along the part, a fraction of its length from 0 to 1");
  verb.add_option("--toward", words_.toward,
                  "Where the thumb's side points: up, down, an axis of the product (+x, -z) or "
                  "x,y,z");
  verb.add_option("--up", words_.up,
                  "Which way is up where the product is taken: an axis (+y) or x,y,z in the "
                  "product's frame; not known if not given, and +z for --toward up");
  verb.add_option("--purpose", words_.purpose, "What it is held for: use or hand-over")
      ->capture_default_str();
  verb.add_option("--hold-weights", words_.weights,
                  "TOML file of palmar grasp fit-holds: weights by which a hold to hand over is "
                  "chosen, in place of the built-in ones");
}

}  // namespace palmar::cli
