// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/study_report.h"

#include <filesystem>
#include <set>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/formats/file.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/report/chart/study_figures.h"
#include "palmar/report/page/file_names.h"
#include "palmar/report/study/face_words.h"
#include "palmar/report/study/study_answer.h"
#include "palmar/report/study/study_csv.h"
#include "palmar/report/study/study_page.h"
#include "palmar/report/study/study_pictures.h"
#include "palmar/report/words/study_words.h"

namespace palmar::report {
namespace {

constexpr int kStudyPictureWidth = 640;  // pixels; the page shows pictures about 540 wide

std::size_t picture_place(int i) { return static_cast<std::size_t>(i); }

void check_folder(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder) && !std::filesystem::is_directory(folder)) {
    throw OutputError(folder.string() + ": is a file; a report needs a folder");
  }
  const std::filesystem::path page = folder / "report.html";
  if (!std::filesystem::is_regular_file(page) || std::filesystem::file_size(page) == 0) return;
  if (formats::read_file(page).find("<meta name=\"generator\" content=\"Palmar ") ==
      std::string::npos) {
    throw UsageError(page.string() +
                     ": was not written by Palmar and would be overwritten; choose another folder "
                     "or move the file");
  }
}

/// The grasp of the typical hand of a condition, or null if nobody holds the product.
const study::StudyRecord* typical_grasp(const study::StudyResults& results,
                                        const study::StudyCondition& condition, int product) {
  std::vector<int> holding;
  for (const int hand : study::hands_of(results.plan, condition)) {
    const study::StudyRecord* record = study::record_of(results, condition, product, hand);
    if (record != nullptr && study::is_in_hand(*record)) holding.push_back(hand);
  }
  if (holding.empty()) return nullptr;
  return study::record_of(results, condition, product, typical_hand(results.plan, holding));
}

std::vector<std::vector<EncodedPicture>> write_pictures(
    const std::filesystem::path& folder, const StudyReportInput& input,
    const study::StudyCondition& condition, const std::vector<study::StudyMaps>& maps,
    const StudyScales& scales, const study::StudyHandMaker& hand_of,
    const StudyReportOptions& options, const Progress& progress) {
  formats::create_folder(folder);
  const study::StudyPlan& plan = input.results.plan;
  std::vector<std::vector<EncodedPicture>> embedded(plan.products.size());
  std::set<std::string> used;
  for (std::size_t p = 0; p < plan.products.size(); ++p) {
    progress.update(0.55 + 0.35 * static_cast<double>(p) / static_cast<double>(embedded.size()),
                    "maps of " + plan.products[p].name);
    const std::string name = unique_file_name(plan.products[p].name, used, FullStops::kReplaced);
    if (maps[p].hands == 0) continue;
    const study::StudyRecord* grasp = typical_grasp(input.results, condition, static_cast<int>(p));
    const PictureOptions drawing{.width = options.picture_width,
                                 .height = options.picture_height,
                                 .language = options.language};
    std::vector<Picture> pictures =
        study_pictures(*input.inputs.base, input.inputs.products[p], plan.products[p].name, maps[p],
                       grasp != nullptr ? grasp->product_from_hand : geometry::Rigid3{}, scales,
                       options.threshold, drawing, progress);
    if (grasp != nullptr && !progress.is_cancelled()) {
      const study::StudyTask task = study::task_at(plan, grasp->number);
      pictures.push_back(
          study_hold_picture(hand_of(task), *grasp, input.inputs.products[p], plan.products[p].name,
                             hand_words(plan, condition, task.hand), drawing, progress));
    }
    progress.throw_if_cancelled();
    std::vector<std::string> full(pictures.size());
    embedded[p].resize(pictures.size());
    parallel_for(static_cast<int>(pictures.size()), [&](int k) {
      const Picture& picture = pictures[picture_place(k)];
      full[picture_place(k)] = encode_png(picture.image);
      embedded[p][picture_place(k)] = {
          .name = picture.name,
          .title = picture.title,
          .alt = picture.alt,
          .png = encode_png(narrowed(picture.image, options.extras.slides ? picture.image.width
                                                                          : kStudyPictureWidth),
                            PngEffort::kSmall),
          .thumbnail = ""};
    });
    for (std::size_t k = 0; k < pictures.size(); ++k) {
      formats::write_file(folder / (name + "_" + pictures[k].name + ".png"), full[k]);
    }
  }
  return embedded;
}

void write_figures(const std::filesystem::path& folder, const std::vector<StudyFigure>& figures) {
  formats::create_folder(folder);
  struct Files {
    std::string svg, png, pdf;
  };
  std::vector<Files> files(figures.size());
  parallel_for(static_cast<int>(figures.size()), [&](int i) {
    const Figure& figure = figures[picture_place(i)].figure;
    files[picture_place(i)] = {to_svg(figure), to_png(figure), to_pdf(figure)};
  });
  for (std::size_t i = 0; i < figures.size(); ++i) {
    formats::write_file(folder / (figures[i].name + ".svg"), files[i].svg);
    formats::write_file(folder / (figures[i].name + ".png"), files[i].png);
    formats::write_file(folder / (figures[i].name + ".pdf"), files[i].pdf);
  }
}

}  // namespace

void StudyReportOptions::check() const {
  comparison.check();
  study::MeanMapOptions{threshold}.check();
  if (most_grasps < 0 || most_grasps > 5000) {
    throw UsageError("study report: most_grasps is " + std::to_string(most_grasps) +
                     "; 0 to 5000 are allowed");
  }
  for (const auto& [field, value] :
       {std::pair{"picture_width", picture_width}, std::pair{"picture_height", picture_height}}) {
    if (value < 64 || value > 8192) {
      throw UsageError(std::string("study report: ") + field + " is " + std::to_string(value) +
                       " pixels; 64 to 8192 are allowed");
    }
  }
}

void write_study_report(const std::string& folder, const StudyReportInput& input,
                        const StudyReportOptions& options, const Progress& progress) {
  options.check();
  const study::StudyResults& results = input.results;
  const study::StudyPlan& plan = results.plan;
  results.check();
  if (results.records.empty()) {
    throw UsageError("study report: no grasp was run yet; there is nothing to report");
  }
  if (!input.inputs.base || input.inputs.products.size() != plan.products.size()) {
    throw UsageError("study report: hand or products are missing");
  }
  const std::filesystem::path root(folder);
  check_folder(root);
  formats::create_folder(root);

  progress.update(0.0, "statistics");
  const study::StudyAnalysis analysis = study::analyse_study(results, options.comparison);
  std::vector<DeskTable> desk;
  for (const NamedTable& one : study_csv(results, analysis)) {
    formats::write_file(root / one.name, records::format_csv(one.table));
    desk.push_back({std::filesystem::path(one.name).stem().string(), one.about, one.table});
  }
  write_desk_tables(root, plan.title.empty() ? plan.name : plan.title, desk, options.extras);
  progress.update(0.1, "figures");
  const Phrases phrases(options.language);
  std::vector<StudyFigure> figures = study_figures(results, analysis);
  figures.insert(figures.end(), options.figures.begin(), options.figures.end());
  for (StudyFigure& one : figures) one.figure.say(phrases);
  if (options.figure_files) write_figures(root / "figures", figures);

  progress.update(0.2, "maps");
  const study::StudyCondition& condition = analysis.conditions.front().condition;
  std::vector<int> vertices;
  for (const product::Product& product : input.inputs.products) {
    vertices.push_back(study::product_map(product.mesh).vertex_count());
  }
  std::vector<study::StudyMaps> maps =
      study::mean_maps(plan, input.records, input.inputs.base->skin.vertex_count(), vertices,
                       {.threshold = options.threshold});
  maps.resize(plan.products.size());  // the first condition's
  StudyScales scales = study_scales(results, maps);
  for (ColourScale* one : {&scales.grasp, &scales.mean, &scales.sd, &scales.above}) {
    one->quantity = phrases(one->quantity);
    one->none = phrases(one->none);
  }

  const std::vector<study::FaceStatistics> faces = study::face_statistics(
      plan, input.inputs.products, input.records, {.threshold = options.threshold});
  if (!faces.empty()) {
    formats::write_file(root / "faces.csv",
                        records::format_csv(face_statistics_csv(plan, input.inputs.products, faces,
                                                                options.threshold)));
  }
  progress.update(0.3, "3-D view");
  const study::StudyHandMaker hand_of = study::study_hand_maker(plan, input.inputs.base);
  std::string scene;
  if (options.most_grasps > 0) {
    scene = study_scene_json({results, input.inputs, maps, condition, input.records, hand_of,
                              scales, faces, options.most_grasps, options.language});
  }
  std::vector<std::vector<EncodedPicture>> pictures(plan.products.size());
  if (options.pictures) {
    pictures =
        write_pictures(root / "maps", input, condition, maps, scales, hand_of, options, progress);
  }
  progress.update(0.95, "report.html");
  const std::vector<study::StudyWarning> warnings =
      study::study_warnings(results, input.inputs.products, input.inputs.base->dimensions);
  const StudyPage page{results,
                       analysis,
                       *input.inputs.base,
                       warnings,
                       figures,
                       scales,
                       pictures,
                       input.inputs.products,
                       faces,
                       std::move(scene),
                       shown_hands(plan, condition, options.most_grasps),
                       options.threshold,
                       input.program,
                       input.digest,
                       options.language,
                       study_answer(results, {.language = options.language,
                                              .comparison = options.comparison,
                                              .store = "",
                                              .command = options.command}),
                       options.extras};
  formats::write_file(root / "report.html", study_page(page));
}

}  // namespace palmar::report
