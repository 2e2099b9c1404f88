// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Images of one DICOM file as a user gives them, packed by GDCM; and what a hostile one may cost.
#include <gdcmImageReader.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "hands/images/gdcm_test_files.h"
#include "run_program.h"

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Json = nlohmann::json;

#if defined(__SANITIZE_ADDRESS__)
constexpr const char* kMemoryLimit = "";  // the sanitizer reserves terabytes
#else
constexpr const char* kMemoryLimit = "ulimit -v 1500000; ";  // kB of addresses: 1.5 GB
#endif

/// A scan of a synthetic person, coarse: a folder of slices. Made once.
const std::string& scan() {
  static const std::string folder = [] {
    const std::string made = temporary_folder();
    const ProgramRun run = run_palmar(
        "phantom mri --seed 4 --side left --pixel-mm 2 --slice-mm 4 --slices 30 --oblique-deg 10 "
        "--posture reference --out p",
        made);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return made;
  }();
  return folder;
}

/// The same scan as GDCM reads it, to be written as one file.
images::GdcmImage scan_of_gdcm() {
  const auto read = [](int slice) {
    char name[64];
    std::snprintf(name, sizeof name, "/p/mri/reference/slice-%04d.dcm", slice);
    gdcm::ImageReader reader;
    reader.SetFileName((scan() + name).c_str());
    if (!reader.Read()) throw std::runtime_error(std::string("GDCM can't read ") + name);
    return reader.GetImage();
  };
  images::GdcmImage image;
  const gdcm::Image first = read(1), second = read(2);
  image.columns = static_cast<int>(first.GetDimension(0));
  image.rows = static_cast<int>(first.GetDimension(1));
  image.frames = 30;
  image.format = first.GetPixelFormat();
  image.slope = first.GetSlope();
  image.intercept = first.GetIntercept();
  double distance = 0.0;
  for (unsigned int axis = 0; axis < 3; ++axis) {
    image.origin[axis] = first.GetOrigin(axis);
    distance += std::pow(second.GetOrigin(axis) - first.GetOrigin(axis), 2);
  }
  image.spacing = {first.GetSpacing(0), first.GetSpacing(1), std::sqrt(distance)};
  for (unsigned int c = 0; c < 6; ++c) image.cosines[c] = first.GetDirectionCosines(c);
  auto values = std::make_shared<std::vector<std::uint16_t>>();
  for (int k = 1; k <= image.frames; ++k) {
    const gdcm::Image slice = read(k);
    const std::size_t at = values->size();
    values->resize(at + slice.GetBufferLength() / 2);
    slice.GetBuffer(reinterpret_cast<char*>(values->data() + at));
  }
  image.value = [values, columns = image.columns, rows = image.rows](int i, int j, int k) {
    return (*values)[static_cast<std::size_t>((k * rows + j) * columns + i)];
  };
  return image;
}

TEST(DicomFile, AnEnhancedFileGivesTheSameImageAsTheFolderOfSlices) {
  const ProgramRun slices = run_palmar("mri info p/mri/reference --json", scan());
  ASSERT_EQ(slices.exit_code, 0) << slices.err;
  const Json expected = Json::parse(slices.out);
  auto ways = images::packed_syntaxes();
  ways.emplace_back("explicit", gdcm::TransferSyntax::ExplicitVRLittleEndian);
  for (const auto& [name, syntax] : ways) {
    images::GdcmImage image = scan_of_gdcm();
    image.syntax = syntax;
    image.write(scan() + "/one.dcm");
    const ProgramRun run = run_palmar("mri info one.dcm --json", scan());
    ASSERT_EQ(run.exit_code, 0) << name << run.err;
    const Json info = Json::parse(run.out);
    for (const char* const key :
         {"size", "intensity_least", "intensity_most", "air_threshold", "noise_deviation"}) {
      EXPECT_EQ(info.at(key), expected.at(key)) << name << " " << key;
    }
    for (const char* const key : {"spacing_mm", "origin_mm", "centre_mm"}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {  // positions as text, 16 characters
        EXPECT_NEAR(info.at(key).at(axis).get<double>(), expected.at(key).at(axis).get<double>(),
                    1e-6)
            << name << " " << key;
      }
    }
    EXPECT_THAT(info.at("odd_slices"), IsEmpty());
  }
  const ProgramRun series = run_palmar("mri series one.dcm --json", scan());
  ASSERT_EQ(series.exit_code, 0) << series.err;
  const Json list = Json::parse(series.out).at("series");
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list.at(0).at("slices"), 30);
  EXPECT_EQ(list.at(0).at("posture"), "reference");
  EXPECT_EQ(list.at(0).at("refusal"), "");
}

TEST(DicomFile, HandFromMriTakesTheFileAndNoSingleSlice) {
  images::GdcmImage image = scan_of_gdcm();
  image.syntax = gdcm::TransferSyntax::JPEGLSLossless;
  image.write(scan() + "/coarse.dcm");
  // Read, taken as the reference by its description, and measured.
  const ProgramRun run = run_palmar("hand from-mri coarse.dcm --out x.hand.glb", scan());
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("series 4 \"reference\" of coarse.dcm: voxels of 2.00 x 2.00 x "
                                 "4.00 mm are too coarse for bones"));
  const ProgramRun slice =
      run_palmar("hand from-mri p/mri/reference/slice-0001.dcm --out x.hand.glb", scan());
  EXPECT_EQ(slice.exit_code, 3);
  EXPECT_THAT(slice.err, HasSubstr("slice-0001.dcm: is one DICOM file of one slice; the folder "
                                   "with its series is required"));
}

TEST(DicomFile, AHostileFileEndsWithCodeThreeWithinItsLimits) {
  const std::string folder = temporary_folder();
  for (const auto& [name, syntax] : images::packed_syntaxes()) {
    images::GdcmImage image;
    image.columns = 64;
    image.rows = 48;
    image.syntax = syntax;
    image.write(folder + "/whole.dcm");
    const std::string whole = read_text(folder + "/whole.dcm");
    write_text(folder + "/cut.dcm", whole.substr(0, whole.size() * 3 / 4));
    const bool has_head = name == "JPEG-LS" || name == "JPEG 2000";
    if (has_head) write_text(folder + "/large.dcm", images::claiming_size(whole, 10000, 10000));
    for (const std::string file : {"cut.dcm", "large.dcm"}) {
      if (file == "large.dcm" && !has_head) continue;
      const auto start = std::chrono::steady_clock::now();
      const int status = std::system(("cd '" + folder + "' && " + kMemoryLimit +
                                      PALMAR_EXECUTABLE " mri info " + file + " >out 2>err")
                                         .c_str());
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
      ASSERT_TRUE(WIFEXITED(status)) << name << " " << file;
      EXPECT_EQ(WEXITSTATUS(status), 3) << name << " " << file;
      EXPECT_THAT(read_text(folder + "/err"), HasSubstr(file)) << name;
      EXPECT_LT(taken.count(), 10.0) << "s " << name << " " << file;
    }
  }
}

}  // namespace
}  // namespace palmar::testing
