// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/mesh/textured_mesh.h"
#include "palmar/hand/anatomy.h"

namespace palmar::capture {

struct SkinMarkOptions {
  geometry::Srgb crease{0.10F, 0.45F, 0.22F};  ///< ink of the lines along creases: green
  geometry::Srgb dot{0.12F, 0.18F, 0.60F};     ///< ink of the dots: blue
  double least_share = 0.4;    ///< of the ink's own colour in skin that counts as drawn on
  double largest_turn = 35.0;  ///< between the colours' shifts from skin to ink, deg
  double dot_diameter = 3.0;   ///< mm; blots of a third to three times its area are dots
  void check() const;          ///< throws UsageError: field, value, allowed range
};

/// A dot that was drawn on the skin.
struct InkDot {
  Vec3 point = Vec3::Zero();             ///< centre, mm
  double area = 0.0;                     ///< mm^2
  std::optional<hand::Segment> segment;  ///< if somebody said which it lies on; the back of the
                                         ///< hand: palm
};

/// A connected piece of a drawn line.
struct InkLine {
  std::vector<Vec3> point;                             ///< vertices under the ink
  std::vector<double> weight;                          ///< of each: area times share of ink, mm^2
  double area = 0.0;                                   ///< mm^2
  std::optional<hand::Segment> crease = std::nullopt;  ///< if somebody said so; see CreaseLabel
};

/// What somebody said of the line nearest to a point: the proximal crease of a segment, of the
/// palm: the wrist's; none: no crease.
struct CreaseLabel {
  Vec3 point = Vec3::Zero();  ///< mm
  std::optional<hand::Segment> crease;
  std::string place;  ///< where it is written: "file:line"
};

struct SkinMarks {
  geometry::Srgb skin = geometry::Srgb::Zero();  ///< middle colour of the bare skin
  std::vector<InkDot> dots;
  std::vector<InkLine> lines;
  std::vector<InkLine> added_lines;  ///< without ink: points somebody gave for a crease
  std::vector<CreaseLabel> crease_labels;
  std::vector<char> is_ink;  ///< per vertex: drawn on
  /// Patches of 20 mm^2 or more whose colour is neither the skin's nor an ink's: rings, nails,
  /// plasters; vertices.
  std::vector<std::vector<int>> other_colour;
  std::vector<std::string> notes;
};

/// Finds dots and lines drawn on a scanned skin by their colours.
///
/// Colours are compared by their chromaticity c = (R, G) / (R + G + B) of linear light, which
/// shadows and the skin's tone hardly change. The skin's is the median s. Ink k, thin or on dark
/// skin, mixes with it: what is drawn on lies from s towards k. A vertex belongs to the ink whose
/// direction is nearest, within `largest_turn`; its share is the way along it over that of well
/// covered skin, the upper tenth of all that are clearly off s (six median deviations) in that
/// direction. Connected vertices with a share of `least_share` or more make one mark; a dot's
/// centre is the mean by area and share.
///
/// What is in an ink's colour and wider than 4 mm over a third of its area or more is neither line
/// nor dot (a watch's strap is dark, as ink is); it belongs to `other_colour`, and a note says so.
///
/// Vertices that are guesses bear no ink, and what is drawn as far as where guesses begin is taken
/// for a backdrop's colour. `mesh`: edges of 1.2 mm at most, or dots of 3 mm aren't found. Throws
/// InputError "`name`: ..." if an ink can't be distinguished from this skin or from the other ink,
/// or the mesh is too coarse.
SkinMarks find_skin_marks(const geometry::ColouredMesh& mesh, const std::string& name,
                          const SkinMarkOptions& options = {});

}  // namespace palmar::capture
