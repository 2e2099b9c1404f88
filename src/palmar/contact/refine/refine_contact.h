// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/contact/contact.h"
#include "palmar/contact/prepared/contact_solver.h"

namespace palmar::contact {

/// Refines the skin of a solved contact where the product turns too far from a loaded vertex to its
/// neighbour (is_unresolved()), if a region has more than kToldShare of its force there: halves the
/// edges (skin_division.h) and solves again, until the peak on cells of the hand, and those of the
/// regions that count, moves by less than kResolvedChange. Regions count whose peak on cells is at
/// least half of the hand's; from the second halving on only their skin is divided. One halving is
/// enough where nothing is left unresolved after it, two are done else; where nothing is left but
/// the peaks moved by more, loaded skin that was divided is divided once more. The hand stays where
/// it is. `solver` has solved `result`.
///
/// On bone, skin that was divided is pressed by the surface that it ends on, not by the one that is
/// nearest to where it began. With u, how the solution moves x, the nearest point of x + u takes
/// the place of that of x, and its tangent plane gives the gap; solved again until the peaks hold.
/// Skin deeper in an edge than its fillet is round has the flat faces beside it nearest, and every
/// fillet would press like a sharp edge.
void refine_contact(const ContactSolver::Impl& solver, const geometry::DistanceField& product,
                    ContactResult& result);

}  // namespace palmar::contact
