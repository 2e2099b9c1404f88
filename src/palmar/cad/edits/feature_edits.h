// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/cad/edits/groove.h"
#include "palmar/cad/model/cad_model.h"
#include "palmar/geometry/types.h"

namespace palmar::cad {

/// Changes of a CAD model's features, as a designer would make them. Which edges and faces: in
/// words, see feature_choice.h; all numbers are those of the model before any change.
struct FilletEdit {
  std::string edges = "long";
  double radius = 0.0;  ///< mm, 0 or more; 0 makes a rounded edge sharp
};
struct OffsetEdit {
  std::string faces;
  double distance = 0.0;  ///< mm; outwards
};
struct TaperEdit {
  std::string faces = "sides";
  double angle = 0.0;  ///< rad; positive: thinner towards `direction`
  /// Faces stay where they cross the plane through `point` across `direction`. Unset: the middle of
  /// the model's box, and its longest direction.
  std::optional<Vec3> point{}, direction{};
};
struct FeatureEdits {
  std::vector<FilletEdit> fillets{};
  std::vector<OffsetEdit> offsets{};
  std::vector<TaperEdit> tapers{};
  std::vector<GrooveEdit> grooves{};
};

struct EditedModel {
  CadModel model;  ///< names and colours of the faces that remain; new fillets "fillet r 10"
  double volume_before = 0.0, volume = 0.0;  ///< mm^3
  std::vector<std::string> notes;
};

/// All changes at once: fillets that are in the way are taken off (their neighbours extended until
/// they meet), faces tapered and moved, then every fillet rolled again, with the radius asked for
/// or the one that it had, and grooves cut. So a change of an edge's radius from 3 to 10 mm equals
/// the edge made with 10 mm.
///
/// Every body that is changed must be a closed solid and stays one: checked by the kernel's own
/// check, closed shell, positive volume. Throws UsageError (unknown edge, body that isn't a solid)
/// and NumericalError naming the feature and its value if it can't be made.
EditedModel edit_features(const CadModel& model, const FeatureEdits& edits);

}  // namespace palmar::cad
