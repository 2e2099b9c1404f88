// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "study/study_report_command.h"

#include <memory>
#include <nlohmann/json.hpp>

#include "palmar/workflow/study/study_report.h"
#include "report_arguments.h"
#include "study/study_comparison_text.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

void add_report(CLI::App& noun, Context& context) {
  struct Options {
    std::string store, out;
    double threshold = 1000.0 * grasp::kBloodFlowStop;  // kPa
    report::StudyReportOptions report;
    ReportArguments arguments;
    bool no_pictures = false, no_figures = false;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(noun, "report", "One page with all figures, comparisons, 3-D views and provenance",
               "palmar study report women.palmar --out report");
  verb->add_option("STORE", o->store, "Study: a *.palmar file")->required();
  verb->add_option("--out", o->out, "Folder for report.html, tables and figures")->required();
  verb->add_option(
          "--threshold-kpa", o->threshold,
          "Maps show the share of hands above this pressure, kPa; 50: blood flow in the skin stops")
      ->capture_default_str();
  verb->add_option("--significance", o->report.comparison.significance,
                   "Level of the corrected p value below which a difference is named")
      ->capture_default_str();
  verb->add_option("--most-grasps", o->report.most_grasps,
                   "Grasps in the 3-D view, chosen evenly by hand length; 0: no view")
      ->capture_default_str();
  o->arguments.add_to(*verb);
  verb->add_flag("--no-pictures", o->no_pictures, "No pictures of the maps");
  verb->add_flag("--no-figures", o->no_figures, "No figures as SVG, PNG and PDF beside the page");
  verb->callback([&context, o] {
    context.run = [&context, o] {
      workflow::StudyReportRequest request;
      request.store = o->store;
      request.folder = o->out;
      request.report = o->report;
      request.pdf = o->arguments.pdf();
      request.report.language = o->arguments.language();
      request.report.extras = o->arguments.extras();
      request.report.threshold = o->threshold / 1000.0;
      request.report.pictures = !o->no_pictures;
      request.report.figure_files = !o->no_figures;
      const std::string page =
          workflow::report_study(request, make_progress(context.common)).string();
      finish_progress();
      print(context.common.json ? Json({{"report", page}}).dump() + "\n" : page + "\n");
      return 0;
    };
  });
}

void add_compare(CLI::App& noun, Context& context) {
  const auto o = std::make_shared<workflow::StudyCompareRequest>();
  const auto language = std::make_shared<std::string>("en");
  o->quantities.clear();
  CLI::App* verb = add_verb(noun, "compare", "Differences between products over the same hands",
                            "palmar study compare women.palmar --quantity peak_pressure_cells_mpa");
  verb->add_option("STORE", o->store, "Study: a *.palmar file")->required();
  verb->add_option("--quantity", o->quantities,
                   "What is compared, one or several: peak_pressure_cells_mpa, contact_area_mm2, "
                   "force_n, an index; all for everything")
      ->delimiter(',');
  verb->add_option("--significance", o->comparison.significance,
                   "Level of the corrected p value below which a difference is named")
      ->capture_default_str();
  verb->add_option("--language", *language, "Language of the verdict: en or de")
      ->capture_default_str();
  verb->callback([&context, o, language] {
    context.run = [&context, o, language] {
      workflow::StudyCompareRequest request = *o;
      request.language = language_named(*language);
      if (request.quantities.empty())
        request.quantities = workflow::StudyCompareRequest{}.quantities;
      const workflow::StudyCompareOutcome outcome = workflow::compare_study(request);
      print(context.common.json ? comparison_object(outcome, o->comparison).dump(2) + "\n"
                                : comparison_text(outcome));
      return 0;
    };
  });
}

}  // namespace

void add_study_report_commands(CLI::App& noun, Context& context) {
  add_report(noun, context);
  add_compare(noun, context);
}

}  // namespace palmar::cli
