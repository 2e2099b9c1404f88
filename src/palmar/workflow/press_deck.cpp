// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/press_deck.h"

#include <fmt/format.h>

#include <numbers>

#include "palmar/contact/press/half_space_press.h"
#include "palmar/formats/file.h"
#include "palmar/hand/tissue_block.h"
#include "palmar/records/fe/tetgen.h"

namespace palmar {
namespace {

/// All but tissue and indenter.
PressDeck empty_deck(const PressDeckRequest& request) {
  PressDeck deck;
  deck.depths = request.depths;
  deck.shear_modulus = request.shear_modulus;
  deck.poisson = request.poisson;
  deck.material = request.material;
  return deck;
}

std::string indenter_words(const PressDeckRequest& request) {
  if (!request.indenter_words.empty()) return request.indenter_words;
  return fmt::format("{} at {:g} deg", name_of(request.indenter),
                     request.tilt * 180.0 / std::numbers::pi);
}

}  // namespace

void PressDeckRequest::check() const {
  TissueBlockOptions{.region = region, .cut_offset = cut_offset, .cut_normal = {}}.check();
  empty_deck(*this).check_test();
  check_largest_tet(largest_tet);
}

PressDeckOutcome write_press_deck(const PressDeckRequest& request) {
  request.check();
  const auto hand = load_hand(request.hand);
  const std::filesystem::path folder(request.out);
  PressDeckOutcome outcome{folder / "press.inp", empty_deck(request)};
  PressDeck& deck = outcome.deck;
  deck.title = fmt::format("{} of hand {}, {}", name_of(request.region), hand->name,
                           indenter_words(request));
  PressOptions press;
  press.specimen = {.kind = PressSpecimen::Kind::kHandRegion, .region = request.region};
  press.indenter = request.indenter;
  press.tilt = request.tilt;
  press.depths = request.depths;
  const Rigid3 frame = indenter_at_first_touch(press, PreparedHand(hand));
  deck.indenter = indenter_surface(request.indenter, frame);
  deck.direction = -(frame.rotation * Vec3::UnitZ());
  const TissueBlockOptions block{
      .region = request.region, .cut_offset = request.cut_offset, .cut_normal = {}};
  deck.block = mesh_by_tetgen(make_tissue_block(*hand, block), folder, request.largest_tet);
  write_file(outcome.file, inp_deck(deck));
  return outcome;
}

}  // namespace palmar
