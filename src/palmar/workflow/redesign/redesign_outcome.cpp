// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/redesign_outcome.h"

#include "palmar/formats/file.h"
#include "palmar/grasp/grip.h"

namespace palmar::workflow {
namespace {

constexpr std::size_t kLeastHands = 6;  // fewer prove nothing, here or elsewhere

}  // namespace

void RedesignOutcome::add_note(const RedesignRequest& request, const std::string& text) {
  notes.push_back(text);
  if (request.on_note) request.on_note(text);
}

void RedesignOutcome::judge(const RedesignRequest& request, const HeldOriginal& made_for,
                            const RedesignedProduct& redesign, const Progress& progress,
                            const std::vector<report::StudyFigure>& figures) {
  const JudgingHands judges = judging_hands(request, made_for, progress);
  comparison = compare_redesigns(request, judges, {redesign}, figures, progress);
  const std::optional<grasp::Hold> hold = judges.original.hold();
  if (judges.original.study.plan.hands.size() < kLeastHands) return;
  if (request.keeps_posture() || !hold || !grasp::is_power(hold->grip) || hold->is_over_end) return;
  gains = hold_gains(judges, redesign.product, *comparison, progress);
  formats::write_file(request.out / "gains.csv", gains_csv(*gains));
  formats::write_file(request.out / "gains.svg", gains_svg(*gains));
}

}  // namespace palmar::workflow
