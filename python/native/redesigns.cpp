// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/report/study/study_answer.h"
#include "palmar/report/study/study_csv.h"
#include "palmar/study/statistics/study_analysis.h"
#include "palmar/workflow/redesign/redesign_feature.h"
#include "palmar/workflow/redesign/redesign_press.h"
#include "palmar/workflow/redesign/redesign_region.h"
#include "palmar/workflow/redesign/redesign_shape.h"
#include "task.h"

namespace palmar::python {
namespace {

workflow::RedesignRequest redesign_of(Arguments& arguments) {
  workflow::RedesignRequest request;
  arguments.take("product", request.product);
  arguments.take("out", request.out);
  arguments.take("unit", request.unit);
  arguments.take("population", request.populations);
  arguments.take("hands", request.hands);
  arguments.take("hand", request.hand);
  arguments.take("left", request.is_left);
  std::vector<std::string> grips;
  arguments.take("grip", grips);
  for (const std::string& name : grips) request.grips.push_back(records::asked_grip_named(name));
  request.holding = holding_of(arguments);
  arguments.take("at", request.at);
  arguments.take("axis", request.axis);
  arguments.take("language", request.language);
  std::string posture;
  if (arguments.take("hold_posture", posture))
    request.posture = workflow::redesign_posture(posture);
  arguments.take("grip_force_n", request.grip_force);
  arguments.take("seed", request.seed);
  arguments.take("command_line", request.command);
  return request;
}

py::dict result_of(const workflow::RedesignOutcome& outcome) {
  py::dict result;
  result["record"] = from_json(outcome.json);
  if (outcome.gains) result["record"]["gains"] = from_json(workflow::gains_json(*outcome.gains));
  result["notes"] = outcome.notes;
  const auto& comparison = outcome.comparison;
  if (!comparison) return result;
  report::StudyAnswerOptions options;
  options.language = comparison->language;
  const report::StudyAnswer answer = report::study_answer(comparison->results, options);
  result["sentence"] = answer.sentence;
  result["reasons"] = answer.reasons;
  result["study"] = comparison->study.string();
  result["report"] = comparison->report.string();
  result["comparison"] =
      table(report::comparison_csv(comparison->results, study::analyse_study(comparison->results)));
  return result;
}

/// Runs a redesign; `task` is called with its request and Progress.
template <typename Request, typename Task>
auto run(const Listeners& listeners, Request& request, const Task& task) {
  return run_task(listeners, [&](const Progress& progress, const workflow::NoteSink& note) {
    request.redesign.on_note = note;
    return task(request, progress);
  });
}

void take_mesh(py::dict& result, const geometry::TriangleMesh& mesh) {
  product::Product made;
  made.mesh = mesh;
  const py::object owner = py::cast(for_python(std::move(made)));
  result["vertices_mm"] = owner.attr("vertices_mm");
  result["triangles"] = owner.attr("triangles");
}

py::dict shape(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::RedesignShapeRequest request;
  request.redesign = redesign_of(arguments);
  arguments.take("vary", request.vary);
  arguments.take("features", request.features);
  arguments.take("goal", request.goal);
  arguments.take("spread_mm", request.spread.along);
  arguments.take("spread_deg", request.spread.turn, geometry::kDegree);
  arguments.take("use", request.uses);
  arguments.take("places", request.spread.places);
  arguments.take("largest_change_mm", request.limits.largest_change);
  arguments.take("smallest_wall_mm", request.limits.smallest_wall);
  arguments.take("smallest_volume", request.limits.smallest_volume);
  arguments.take("largest_volume", request.limits.largest_volume);
  arguments.take("smallest_radius_mm", request.limits.smallest_radius);
  arguments.take("pull", request.limits.pull);
  request.limits.draft = 2.0 * geometry::kDegree;  // as on the command line
  arguments.take("draft_deg", request.limits.draft, geometry::kDegree);
  arguments.take("draft_land_mm", request.limits.land);
  arguments.take("lost_hands", request.limits.lost_hands);
  arguments.take("both_hands", request.limits.suits_both_hands);
  arguments.take("keep_ends_mm", request.limits.kept_ends);
  arguments.take("keep_face", request.limits.kept_faces);
  arguments.take("keep_box", request.limits.kept_boxes);
  arguments.take("end_radius_mm", request.end_radius);
  arguments.take("evaluations", request.search.evaluations);
  arguments.take("pick", request.pick);
  arguments.take("pictures", request.draws);
  arguments.take("compare", request.compares);
  arguments.finish();
  const workflow::RedesignShapeOutcome outcome =
      run({progress, note}, request, &workflow::redesign_shape);
  py::dict result = result_of(outcome);
  result["file"] = outcome.file.string();
  return result;
}

py::dict press(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::RedesignPressRequest request;
  request.redesign = redesign_of(arguments);
  redesign::PressedShapeOptions& options = request.shape;
  arguments.take("overlap_share", options.share);
  std::string over;
  if (arguments.take("over", over)) options.combine = workflow::combine_options(over);
  arguments.take("align", request.aligns);
  arguments.take("largest_depth_mm", options.depth_limit);
  arguments.take("wall_mm", options.wall);
  arguments.take("keep_face", request.keep_faces);
  arguments.take("keep_box", options.keep_out.boxes);
  arguments.take("keep_blend_mm", options.keep_out.blend);
  arguments.take("smoothing_mm", options.smoothing);
  arguments.take("rim_mm", options.rim_width);
  arguments.take("edge_mm", options.edge_length);
  arguments.take("format", request.formats);
  arguments.take("pictures", request.draws);
  arguments.take("compare", request.compares);
  arguments.finish();
  const workflow::RedesignPressOutcome outcome =
      run({progress, note}, request, &workflow::redesign_press);
  py::dict result = result_of(outcome);
  result["file"] = outcome.file.string();
  take_mesh(result, outcome.shape.mesh);
  return result;
}

/// "any", "half" or a share, as 0 to 1.
void take_share(Arguments& arguments, const char* name, double& share) {
  const py::object given = arguments.get(name);
  if (!given) return;
  if (py::isinstance<py::str>(given)) {
    const auto words = given.cast<std::string>();
    if (words != "any" && words != "half") {
      throw UsageError("setting \"" + std::string(name) + "\" is \"" + words +
                       "\"; any, half, or a share of the hands from 0 to 1");
    }
    share = words == "half" ? 0.5 : 0.0;
    return;
  }
  arguments.take(name, share);
}

py::dict region(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::RedesignRegionRequest request;
  request.redesign = redesign_of(arguments);
  take_share(arguments, "hands_share", request.region.share);
  arguments.take("threshold_kpa", request.threshold, 1e-3);
  arguments.take("smoothing_mm", request.region.smoothing);
  arguments.take("smallest_area_mm2", request.region.smallest_area);
  arguments.take("pressed_share", request.pressed_share);
  arguments.take("relief", request.relieves);
  take_share(arguments, "relief_share", request.relief_share);
  arguments.take("fit_share", request.relief.share);
  arguments.take("largest_depth_mm", request.relief.largest_depth);
  arguments.take("smallest_radius_mm", request.relief.smallest_radius);
  arguments.take("run_out_mm", request.relief.run_out);
  arguments.take("junction_radius_mm", request.junction_radius);
  arguments.take("pictures", request.draws);
  arguments.take("compare", request.compares);
  arguments.finish();
  return result_of(run({progress, note}, request, &workflow::redesign_region));
}

py::dict features(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::RedesignFeatureRequest request;
  request.redesign = redesign_of(arguments);
  arguments.take("vary", request.vary);
  arguments.take("goal", request.goal);
  arguments.take("largest_offset_mm", request.limits.largest_offset);
  arguments.take("keep_face", request.limits.keep_out);
  arguments.take("smallest_radius_mm", request.limits.smallest_radius);
  arguments.take("smallest_volume", request.limits.smallest_volume);
  arguments.take("largest_volume", request.limits.largest_volume);
  arguments.take("least_grip_force", request.limits.least_grip_force);
  arguments.take("lost_hands", request.limits.lost_hands);
  arguments.take("groove_radius_mm", request.grooves.radius);
  arguments.take("groove_rim_mm", request.grooves.rim);
  arguments.take("smallest_groove_radius_mm", request.smallest_groove_radius);
  arguments.take("propose", request.proposes);
  arguments.take("evaluations", request.search.evaluations);
  arguments.take("step_mm", request.step);
  std::string optimiser;
  if (arguments.take("optimiser", optimiser))
    request.search.method = redesign::search_method(optimiser);
  arguments.take("compare", request.compares);
  arguments.finish();
  const workflow::RedesignFeatureOutcome outcome =
      run({progress, note}, request, &workflow::redesign_features);
  py::dict result = result_of(outcome);
  if (outcome.redesign) result["file"] = outcome.redesign->step.string();
  return result;
}

}  // namespace

void bind_redesigns(py::module_& module) {
  module.def("redesign_shape", &shape, py::arg("arguments"), py::arg("progress"), py::arg("note"));
  module.def("redesign_press", &press, py::arg("arguments"), py::arg("progress"), py::arg("note"));
  module.def("redesign_region", &region, py::arg("arguments"), py::arg("progress"),
             py::arg("note"));
  module.def("redesign_features", &features, py::arg("arguments"), py::arg("progress"),
             py::arg("note"));
}

}  // namespace palmar::python
