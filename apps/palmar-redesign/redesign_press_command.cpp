// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "redesign_arguments.h"
#include "redesign_text.h"

namespace palmar::cli {
namespace {

struct PressArguments {
  RedesignArguments redesign;
  workflow::RedesignPressRequest request;
  std::string over = workflow::name_of(redesign::CombineOptions{});
  std::string align = "none";
  std::vector<std::string> keep_boxes;
  bool no_pictures = false;
  bool no_compare = false;
};

int run_press(const PressArguments& a, const Context& context) {
  workflow::RedesignPressRequest request = a.request;
  request.shape.combine = workflow::combine_options(a.over);
  request.shape.keep_out.boxes = kept_boxes(a.keep_boxes);
  request.redesign = a.redesign.read(context);
  request.aligns = a.align == "axis";
  request.draws = !a.no_pictures;
  request.compares = !a.no_compare;
  request.on_shape = [&context](const workflow::RedesignPressOutcome& outcome) {
    finish_progress();
    if (!context.common.json) print(press_text(outcome));
  };
  const workflow::RedesignPressOutcome outcome =
      workflow::redesign_press(request, make_progress(context.common));
  print_redesign(outcome, context);
  return 0;
}

}  // namespace

void add_redesign_press_command(CLI::App& noun, Context& context) {
  const auto a = std::make_shared<PressArguments>();
  CLI::App* verb =
      add_verb(noun, "press",
               "Press the product's surface in where hands reach into it: concaves of fingers",
               "palmar redesign press handle.step --hands 30 --overlap-share 0.5 --keep-face 4 "
               "--out pressed");
  a->redesign.add_to(*verb);
  redesign::PressedShapeOptions& o = a->request.shape;
  verb->add_option("--overlap-share", o.share,
                   "Share of the overlap of undeformed skin and product that is removed, 0 to 1")
      ->capture_default_str();
  verb->add_option(
          "--over", a->over,
          "Overlap over hands: mean, or a percentile (75); hands that don't touch count as "
          "0. mean-of-touching, 75-of-touching: without them")
      ->capture_default_str();
  verb->add_option("--align", a->align,
                   "axis: before they are combined, shift every hand along the handle until its "
                   "imprint fits those of all best")
      ->check(CLI::IsMember({"none", "axis"}))
      ->capture_default_str();
  verb->add_option("--largest-depth-mm", o.depth_limit, "Largest depth, mm")->capture_default_str();
  verb->add_option("--wall-mm", o.wall, "Wall thickness that must remain, mm")
      ->capture_default_str();
  verb->add_option("--keep-face", a->request.keep_faces,
                   "CAD face that must stay as it is: its number or name; may be repeated")
      ->allow_extra_args(false);
  add_kept_boxes(*verb, a->keep_boxes);
  verb->add_option("--keep-blend-mm", o.keep_out.blend,
                   "Width over which the depth grows beside kept faces and boxes, mm")
      ->capture_default_str();
  verb->add_option("--smoothing-mm", o.smoothing, "Standard deviation of the smoothing, mm")
      ->capture_default_str();
  verb->add_option("--rim-mm", o.rim_width,
                   "Width round the imprint over which the depth falls to 0, mm")
      ->capture_default_str();
  verb->add_option("--edge-mm", o.edge_length, "Longest edge of triangles that move, mm")
      ->capture_default_str();
  verb->add_option("--format", a->request.formats,
                   "stl, obj, ply: file of the shape; may be repeated")
      ->check(CLI::IsMember({"stl", "obj", "ply"}))
      ->allow_extra_args(false)
      ->capture_default_str();
  verb->add_flag("--no-pictures", a->no_pictures, "Leave out the pictures");
  verb->add_flag("--no-compare", a->no_compare, "Only make the shape, without a comparison");
  verb->callback([a, &context] {
    context.setting_options = {{"rim width", "--rim-mm"}, {"edge length", "--edge-mm"}};
    context.run = [a, &context] { return run_press(*a, context); };
  });
}

}  // namespace palmar::cli
