// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/image/dicom_compressed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/image/dicom_test_files.h"
#include "palmar/formats/process/external_program.h"
#include "palmar/formats/test_files.h"

namespace palmar {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string bytes_of(std::initializer_list<int> values) {
  std::string bytes;
  for (const int value : values) bytes += static_cast<char>(value);
  return bytes;
}

/// A lossless JPEG of 2 x 2 samples of 8 bits by hand. Codes: 0 for no difference, 10 for one of 1
/// bit, 110 for one of 8 bits.
std::string jpeg(const std::string& extra, int predictor, const std::string& samples) {
  return bytes_of({0xFF, 0xD8, 0xFF, 0xC3, 0, 11, 8, 0, 2, 0, 2, 1, 1, 0x11, 0,  //
                   0xFF, 0xC4, 0,    22,   0, 1,  1, 1, 0, 0, 0, 0, 0, 0,    0,
                   0,    0,    0,    0,    0, 0,  //
                   0,    1,    8}) +
         extra + bytes_of({0xFF, 0xDA, 0, 8, 1, 1, 0, predictor, 0, 0}) + samples +
         bytes_of({0xFF, 0xD9});
}

TEST(LosslessJpeg, SamplesCodedByHandDecode) {
  // Predictor 1. 129 = 128 + 1: 10 1. 129: 0. 1 = 129 (above) - 128: 110 01111111. 2 = 1 + 1: 10 1.
  // 10101100 11111111 01, filled with ones; FF is followed by 0.
  const std::string samples = bytes_of({0xAC, 0xFF, 0x00, 0x7F});
  EXPECT_THAT(lossless_jpeg(jpeg("", 1, samples), 2, 2, "a"), ElementsAre(129, 129, 1, 2));
  // Predictor 2: the last is 129 (above) + 1.
  EXPECT_THAT(lossless_jpeg(jpeg("", 2, samples), 2, 2, "a"), ElementsAre(129, 129, 1, 130));
  // Predictor 4: 1 (left) + 129 (above) - 129 (above left) + 1.
  EXPECT_THAT(lossless_jpeg(jpeg("", 4, samples), 2, 2, "a"), ElementsAre(129, 129, 1, 2));
}

TEST(LosslessJpeg, RestartsBeginFromTheMiddleAgain) {
  // Every row by itself: 129, 129 | 129 = 128 + 1, 1 = 129 - 128.
  const std::string every_row = bytes_of({0xFF, 0xDD, 0, 4, 0, 2});
  const std::string samples = bytes_of({0xAF, 0xFF, 0xD0, 0xB9, 0xFF, 0x00});
  EXPECT_THAT(lossless_jpeg(jpeg(every_row, 2, samples), 2, 2, "a"), ElementsAre(129, 129, 129, 1));
}

TEST(LosslessJpeg, DamageIsNamed) {
  const auto message = [](const std::string& bytes, int columns = 2, int rows = 2) {
    return message_of<InputError>([&] { lossless_jpeg(bytes, columns, rows, "a.dcm"); });
  };
  const std::string samples = bytes_of({0xAC, 0xFF, 0x00, 0x7F});
  EXPECT_THAT(message(jpeg("", 9, samples)),
              HasSubstr("a.dcm: its compressed image has predictor"));
  EXPECT_THAT(message(jpeg("", 1, samples), 3), HasSubstr("has 2 x 2 pixels; the file says 3 x 2"));
  EXPECT_THAT(message(jpeg("", 1, samples.substr(0, 1))), HasSubstr("damaged or cut off (byte"));
  EXPECT_THAT(message("no JPEG"), HasSubstr("doesn't begin as JPEG does"));
  EXPECT_THAT(message(jpeg("", 1, samples).substr(0, 30)), HasSubstr("is cut off"));
  EXPECT_THAT(message(bytes_of({0xFF, 0xD8, 0xFF, 0xC0, 0, 2})), HasSubstr("the marker FFC0"));
}

/// A slice of 2 x 2 pixels with its pixels in fragments: a table of offsets and two parts.
std::string compressed_slice(double z, const std::string& syntax, const std::string& packed) {
  DicomTestFile file = DicomTestFile::slice(2, 2, z);
  file.transfer_syntax = syntax;
  file.element.erase(0x7FE00010);
  const std::string item = bytes_of({0xFE, 0xFF, 0x00, 0xE0});
  const auto part = [&](const std::string& bytes) {
    return item + DicomTestFile::four_bytes(bytes.size()) + bytes;
  };
  const std::size_t half = packed.size() / 4 * 2;
  return file.bytes() + bytes_of({0xE0, 0x7F, 0x10, 0x00, 'O', 'B', 0, 0, 0xFF, 0xFF, 0xFF, 0xFF}) +
         part("") + part(packed.substr(0, half)) + part(packed.substr(half)) +
         bytes_of({0xFE, 0xFF, 0xDD, 0xE0, 0, 0, 0, 0});
}

std::string run_lengths() {
  // 0101, 0101, 0101, 0203: high bytes 01 x 3, then 02; low bytes 01 x 3, then 03.
  std::string packed =
      DicomTestFile::four_bytes(2) + DicomTestFile::four_bytes(64) + DicomTestFile::four_bytes(68);
  packed.resize(64, '\0');
  return packed + bytes_of({0xFE, 1, 0, 2, 0xFE, 1, 0, 3});
}

TEST(DicomCompressed, RunLengthsByHandRead) {
  const TestFolder folder;
  fs::create_directories(folder / "s");
  for (int k = 0; k < 2; ++k) {
    write_file(folder / ("s/" + std::to_string(k)),
               compressed_slice(k, "1.2.840.10008.1.2.5", run_lengths()));
  }
  EXPECT_THAT(read_image(folder / "s").image.value,
              ElementsAre(257, 257, 257, 515, 257, 257, 257, 515));
}

TEST(DicomCompressed, OtherCompressionIsRefusedByName) {
  const TestFolder folder;
  const auto message = [&](const std::string& syntax, const std::string& packed) {
    fs::create_directories(folder / "s");
    DicomTestFile::slice(2, 2, 0).write(folder / "s/0");
    write_file(folder / "s/1", compressed_slice(1.0, syntax, packed));
    return message_of<InputError>([&] { read_image(folder / "s"); });
  };
  EXPECT_THAT(message("1.2.840.10008.1.2.4.90", "abcd"),
              HasSubstr("s/1: is compressed (JPEG 2000), which isn't read"));
  EXPECT_THAT(message("1.2.840.10008.1.2.4.80", "abcd"), HasSubstr("(JPEG-LS)"));
  EXPECT_THAT(message("1.2.840.10008.1.2.4.50", "abcd"), HasSubstr("(lossy JPEG)"));
  EXPECT_THAT(message("1.2.3", "abcd"), HasSubstr("(transfer syntax 1.2.3)"));
  EXPECT_THAT(message("1.2.840.10008.1.2.5", run_lengths().substr(0, 70)),
              HasSubstr("s/1: its run lengths end too early"));
  EXPECT_THAT(message("1.2.840.10008.1.2.4.70", "abcd"),
              HasSubstr("s/1: its compressed image doesn't begin as JPEG does"));
}

TEST(DicomCompressed, WhatAnotherProgramCompressesReadsBackExactly) {
  if (!find_program("dcmcjpeg") || !find_program("dcmcrle")) {
    GTEST_SKIP() << "dcmcjpeg and dcmcrle (Debian package dcmtk) aren't installed";
  }
  const TestFolder folder;
  Volume image;
  image.grid.size = {23, 17, 2};
  std::mt19937 random(1);
  for (std::size_t v = 0; v < image.grid.count(); ++v) {
    image.value.push_back(static_cast<float>(v % 23 * 40 + random() % 300));
  }
  write_dicom_series(folder / "s", image, {});
  const std::vector<std::vector<std::string>> ways = {
      {"dcmcrle"}, {"dcmcjpeg", "+e1"}, {"dcmcjpeg", "+el", "+sv", "7"}};
  for (const auto& way : ways) {
    fs::create_directories(folder / "c");
    for (const std::string slice : {"slice-0001.dcm", "slice-0002.dcm"}) {
      std::vector<std::string> arguments(way.begin() + 1, way.end());
      arguments.push_back("s/" + slice);
      arguments.push_back("c/" + slice);
      ASSERT_EQ(run_program(*find_program(way[0]), arguments, folder.path(), "log"), 0);
    }
    EXPECT_EQ(read_image(folder / "c").image.value, image.value) << way.back();
  }
}

TEST(DicomCompressed, FuzzedFilesAreReadOrRefusedByName) {
  const TestFolder folder;
  fs::create_directories(folder / "s");
  const std::string samples = bytes_of({0xAC, 0xFF, 0x00, 0x7F});
  const std::string whole[] = {
      compressed_slice(1.0, "1.2.840.10008.1.2.5", run_lengths()),
      compressed_slice(1.0, "1.2.840.10008.1.2.4.70", jpeg("", 1, samples))};
  DicomTestFile::slice(2, 2, 0).write(folder / "s/0");
  std::mt19937 random(5);
  const auto any = [&](std::size_t below) { return static_cast<std::size_t>(random()) % below; };
  for (int n = 0; n < 400; ++n) {
    std::string bytes = whole[n % 2];
    const std::size_t from = n % 3 == 0 ? 128 : bytes.size() - 110;  // mostly the pixels
    for (std::size_t m = 0; m < 1 + any(3); ++m) {
      bytes[from + any(bytes.size() - from)] = static_cast<char>(any(256));
    }
    if (n % 9 == 0) bytes.resize(any(bytes.size()));
    std::ofstream(folder / "s/1", std::ios::binary) << bytes;
    try {
      EXPECT_LE(read_image(folder / "s").image.value.size(), 8U);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("/s"));
    }
  }
}

}  // namespace
}  // namespace palmar
