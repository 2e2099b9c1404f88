// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/press_deck.h"

#include <fmt/format.h>

#include <numbers>

#include "palmar/contact/press/half_space_press.h"
#include "palmar/formats/file.h"
#include "palmar/hand/tissue_block.h"
#include "palmar/records/fe/tetgen.h"

namespace palmar::workflow {
namespace {

/// All but tissue and indenter.
records::PressDeck empty_deck(const PressDeckRequest& request) {
  records::PressDeck deck;
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
  hand::TissueBlockOptions{.region = region, .cut_offset = cut_offset, .cut_normal = {}}.check();
  empty_deck(*this).check_test();
  records::check_largest_tet(largest_tet);
}

PressDeckOutcome write_press_deck(const PressDeckRequest& request) {
  request.check();
  const auto hand = load_hand(request.hand);
  const std::filesystem::path folder(request.out);
  PressDeckOutcome outcome{folder / "press.inp", empty_deck(request)};
  records::PressDeck& deck = outcome.deck;
  deck.title = fmt::format("{} of hand {}, {}", name_of(request.region), hand->name,
                           indenter_words(request));
  contact::PressOptions press;
  press.specimen = {.kind = contact::PressSpecimen::Kind::kHandRegion, .region = request.region};
  press.indenter = request.indenter;
  press.tilt = request.tilt;
  press.depths = request.depths;
  const geometry::Rigid3 frame =
      contact::indenter_at_first_touch(press, contact::PreparedHand(hand));
  deck.indenter = records::indenter_surface(request.indenter, frame);
  deck.direction = -(frame.rotation * Vec3::UnitZ());
  const hand::TissueBlockOptions block{
      .region = request.region, .cut_offset = request.cut_offset, .cut_normal = {}};
  deck.block =
      records::mesh_by_tetgen(hand::make_tissue_block(*hand, block), folder, request.largest_tet);
  formats::write_file(outcome.file, records::inp_deck(deck));
  return outcome;
}

}  // namespace palmar::workflow
