// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hands/person_workflow/steps/mri_steps.h"
#include "mri/mri_commands.h"
#include "mri/mri_step_commands.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

int run_series(const std::string& folder, const Context& context) {
  const std::vector<images::DicomSeries> all = images::find_dicom_series(folder);
  Json list = Json::array();
  std::string text = fmt::format("{:>6}  {:<24} {:<8} {:<4} {:>16}  {}\n", "number", "description",
                                 "modality", "side", "slices, pixels", "posture");
  for (const images::DicomSeries& series : all) {
    const auto posture = hand::scan_posture_in(series.description);
    const std::string posture_name = posture ? std::string(name_of(*posture)) : "";
    list.push_back({{"number", series.number},
                    {"description", series.description},
                    {"modality", series.modality},
                    {"laterality", series.laterality},
                    {"slices", series.slices},
                    {"columns", series.columns},
                    {"rows", series.rows},
                    {"posture", posture_name},
                    {"uid", series.uid},
                    {"first_file", series.files.empty() ? "" : series.files.front()},
                    {"refusal", series.refusal}});
    text += fmt::format("{:>6}  {:<24} {:<8} {:<4} {:>16}  {}\n", series.number,
                        series.description.empty() ? "-" : series.description,
                        series.modality.empty() ? "-" : series.modality,
                        series.laterality.empty() ? "-" : series.laterality,
                        fmt::format("{} of {} x {}", series.slices, series.columns, series.rows),
                        posture_name.empty() ? "-" : posture_name);
    if (!series.refusal.empty()) text += fmt::format("{:8}no volume: {}\n", "", series.refusal);
  }
  print(context.common.json ? Json{{"folder", folder}, {"series", list}}.dump(2) + "\n" : text);
  return 0;
}

struct InfoArguments {
  std::string image;
  images::SeriesChoice choice;
};

int run_info(const InfoArguments& arguments, const Context& context) {
  const person_workflow::MriImageInfo info = person_workflow::describe_mri_image(
      arguments.image, arguments.choice, make_progress(context.common));
  finish_progress();
  const images::ImageFile& file = info.file;
  for (const std::string& text : file.notes) note(context.common, text);
  for (const std::string& text : file.odd_slices) note(context.common, text);
  if (!info.no_hand.empty()) note(context.common, info.no_hand + "; air and noise aren't known");
  const imaging::VolumeGrid& grid = file.image.grid;
  const auto number = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
  };
  if (context.common.json) {
    print(Json{{"image", arguments.image},
               {"description", file.description},
               {"laterality", file.laterality},
               {"size", grid.size},
               {"spacing_mm", vector_json(grid.spacing)},
               {"origin_mm", vector_json(grid.origin)},
               {"centre_mm", vector_json(info.centre)},
               {"axes",
                {vector_json(grid.axes.col(0)), vector_json(grid.axes.col(1)),
                 vector_json(grid.axes.col(2))}},
               {"intensity_least", info.least},
               {"intensity_most", info.most},
               {"air_threshold", number(info.air_threshold)},
               {"noise_deviation", number(info.noise)},
               {"notes", file.notes},
               {"odd_slices", file.odd_slices}}
              .dump(2) +
          "\n");
    return 0;
  }
  const auto axis = [&](int a) {
    const Vec3 v = grid.axes.col(a);
    return fmt::format("({:.4f}, {:.4f}, {:.4f})", v.x(), v.y(), v.z());
  };
  print(fmt::format(
      "{}\n"
      "side          {}\n"
      "voxels        {} x {} x {}\n"
      "spacing       {:g} x {:g} x {:g} mm\n"
      "first voxel   ({:.2f}, {:.2f}, {:.2f}) mm; x to the patient's left, y to the back, z to "
      "the head\n"
      "axes          i {}, j {}, k {}\n"
      "intensity     {:g} to {:g}; {}\n",
      file.description.empty() ? arguments.image : file.description,
      file.laterality.empty() ? "not said" : file.laterality, grid.size[0], grid.size[1],
      grid.size[2], grid.spacing[0], grid.spacing[1], grid.spacing[2], grid.origin.x(),
      grid.origin.y(), grid.origin.z(), axis(0), axis(1), axis(2), info.least, info.most,
      info.noise ? fmt::format("air up to {:.1f}; noise {:.1f} (standard deviation)",
                               *info.air_threshold, *info.noise)
                 : "air and noise aren't known"));
  return 0;
}

}  // namespace

void add_mri_commands(CLI::App& app, Context& context) {
  CLI::App* mri = app.add_subcommand("mri", "MR images: contents, single steps");
  mri->require_subcommand(1);
  mri->fallthrough();

  const auto folder = std::make_shared<std::string>();
  CLI::App* series = add_verb(*mri, "series", "Series in a folder of DICOM files, or in one file",
                              "palmar mri series subject3/mri");
  series
      ->add_option("FOLDER", *folder, "Folder to search, with the folders in it; or one DICOM file")
      ->required();
  series->callback([&context, folder] {
    context.run = [&context, folder] { return run_series(*folder, context); };
  });

  const auto o = std::make_shared<InfoArguments>();
  CLI::App* info = add_verb(*mri, "info", "Size, place and intensities of one image",
                            "palmar mri info subject3/mri --series 1");
  info->add_option("IMAGE", o->image,
                   "Folder of DICOM files, DICOM file of several frames, .nii or .nii.gz")
      ->required();
  info->add_option("--series", o->choice.number, "Number of the series, if there are several");
  info->add_option("--description", o->choice.description,
                   "Part of its description, instead of the number");
  info->callback([&context, o] { context.run = [&context, o] { return run_info(*o, context); }; });
  add_mri_steps(*mri, context);
  mri->footer("Example: palmar mri series subject3/mri");
}

}  // namespace palmar::cli
