// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/dicom_compressed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <random>

#include "hands/images/dicom_test_files.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/external_program.h"
#include "palmar/formats/process/program_missing.h"
#include "palmar/formats/test_files.h"

namespace palmar::images {
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

std::string bytes_of_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

// The same 4 x 3 pixels of 12 bits, compressed by programs that share no code with the decoders
// here but for OpenJPEG.
const std::vector<float> kPixels = {257, 1000, 4095, 0, 17, 2048, 300, 301, 302, 303, 512, 511};
/// dcmtk 3.6.7: dcmcjpls
const std::string kJpegLs = bytes_of_hex(
    "ffd8fff7000b100003000401011100fff8000d01ffff0012004301140040ffda00080101000000006015cd0216"
    "9000bbe6100169b2ce3aed05a88020ffd9");
/// OpenJPEG 2.5: opj_compress -n 1
const std::string kJpeg2000 = bytes_of_hex(
    "ff4fff5100290000000000040000000300000000000000000000000400000003000000000000000000010b0101"
    "ff52000c00000001000004040001ff5c00044060ff90000a0000000000250001ff93dfe0501cfaba48a647e872"
    "e0371244571379d0057b2bf6ffd9");
/// dcmtk 3.6.7: dcmcjpeg +ee, 12 bits, with loss
const std::string kLossyJpeg = bytes_of_hex(
    "ffd8ffe000104a46494600010100000100010000ffdb0043000302020302020303030304030304050805050404"
    "050a070706080c0a0c0c0b0a0b0b0d0e12100d0e110e0b0b1016101113141515150c0f171816141812141514ff"
    "c1000b0c0003000401011100ffc4001400010000000000000000000000000000000dffc4001f10000202020105"
    "000000000000000000000506040803070901020a1215ffda0008010100003f003f02e4da0dc1e4d74fb8c28fca"
    "8ed06ebd4078fbaa6028e54454dc26a4145dafba2d698988d0bd7e901fdfb60af06c8c4d4e4d73e38fc187eb33"
    "bab73292eb34eb29a273ff00ffffd9");

constexpr const char* kRle = "1.2.840.10008.1.2.5";
constexpr const char* kLosslessJpeg = "1.2.840.10008.1.2.4.70";

/// Pixel Data in fragments: a table of offsets and these.
std::string fragments(const std::string& table, const std::vector<std::string>& parts) {
  std::string bytes = bytes_of({0xE0, 0x7F, 0x10, 0x00, 'O', 'B', 0, 0, 0xFF, 0xFF, 0xFF, 0xFF});
  const auto add = [&](const std::string& part) {
    bytes += bytes_of({0xFE, 0xFF, 0x00, 0xE0}) + DicomTestFile::four_bytes(part.size()) + part;
  };
  add(table);
  for (const std::string& part : parts) add(part);
  return bytes + bytes_of({0xFE, 0xFF, 0xDD, 0xE0, 0, 0, 0, 0});
}

/// A slice with its pixels in two fragments.
std::string compressed_slice(DicomTestFile file, const std::string& syntax,
                             const std::string& packed) {
  file.transfer_syntax = syntax;
  file.element.erase(0x7FE00010);
  const std::size_t half = packed.size() / 4 * 2;
  return file.bytes() + fragments("", {packed.substr(0, half), packed.substr(half)});
}
std::string compressed_slice(double z, const std::string& syntax, const std::string& packed) {
  return compressed_slice(DicomTestFile::slice(2, 2, z), syntax, packed);
}
/// A slice of kPixels.
std::string compressed_pixels(double z, const std::string& syntax, const std::string& packed) {
  DicomTestFile file = DicomTestFile::slice(4, 3, z);
  file.number(0x00280101, 12);
  file.number(0x00280102, 11);
  return compressed_slice(file, syntax, packed);
}

std::string run_lengths() {
  // 0101, 0101, 0101, 0203: high bytes 01 x 3, then 02; low bytes 01 x 3, then 03.
  std::string packed =
      DicomTestFile::four_bytes(2) + DicomTestFile::four_bytes(64) + DicomTestFile::four_bytes(68);
  packed.resize(64, '\0');
  return packed + bytes_of({0xFE, 1, 0, 2, 0xFE, 1, 0, 3});
}

/// A folder with two slices.
ImageFile read_two(const std::string& first, const std::string& second) {
  const formats::TestFolder folder;
  fs::create_directories(folder / "s");
  formats::write_file(folder / "s/0", first);
  formats::write_file(folder / "s/1", second);
  return read_image(folder / "s");
}

TEST(DicomCompressed, LosslessJpegCodedByHandReads) {
  // Predictor 1. 129 = 128 + 1: 10 1. 129: 0. 1 = 129 (above) - 128: 110 01111111. 2 = 1 + 1: 10 1.
  // 10101100 11111111 01, filled with ones; FF is followed by 0.
  const std::string samples = bytes_of({0xAC, 0xFF, 0x00, 0x7F});
  const auto slice = [&](double z, int predictor) {
    DicomTestFile file = DicomTestFile::slice(2, 2, z);
    file.number(0x00280100, 8);
    file.number(0x00280101, 8);
    file.number(0x00280102, 7);
    return compressed_slice(file, predictor == 1 ? kLosslessJpeg : "1.2.840.10008.1.2.4.57",
                            jpeg("", predictor, samples));
  };
  // Predictor 4: 1 (left) + 129 (above) - 129 (above left) + 1. Predictor 2: the last is 129
  // (above) + 1.
  EXPECT_THAT(read_two(slice(0, 1), slice(1, 4)).image.value,
              ElementsAre(129, 129, 1, 2, 129, 129, 1, 2));
  EXPECT_THAT(read_two(slice(0, 1), slice(1, 2)).image.value,
              ElementsAre(129, 129, 1, 2, 129, 129, 1, 130));
}

TEST(DicomCompressed, JpegLsAndJpeg2000OfOtherProgramsReadExactly) {
  const ImageFile file = read_two(compressed_pixels(0.0, "1.2.840.10008.1.2.4.80", kJpegLs),
                                  compressed_pixels(1.0, "1.2.840.10008.1.2.4.90", kJpeg2000));
  EXPECT_EQ(std::vector<float>(file.image.value.begin(), file.image.value.begin() + 12), kPixels);
  EXPECT_EQ(std::vector<float>(file.image.value.begin() + 12, file.image.value.end()), kPixels);
  EXPECT_TRUE(file.notes.empty());
}

TEST(DicomCompressed, LossyJpegReadsWithANote) {
  const ImageFile file = read_two(compressed_pixels(0.0, "1.2.840.10008.1.2.4.51", kLossyJpeg),
                                  compressed_pixels(1.0, "1.2.840.10008.1.2.4.51", kLossyJpeg));
  for (std::size_t p = 0; p < 12; ++p) {
    // Steps of up to 24 per frequency, 13 of which matter: far below the range of 4096.
    EXPECT_NEAR(file.image.value[p], kPixels[p], 60.0F) << p;
  }
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("compressed with loss")));
}

TEST(DicomCompressed, RunLengthsByHandRead) {
  const ImageFile file =
      read_two(compressed_slice(0, kRle, run_lengths()), compressed_slice(1, kRle, run_lengths()));
  EXPECT_THAT(file.image.value, ElementsAre(257, 257, 257, 515, 257, 257, 257, 515));
}

TEST(DicomCompressed, FramesOfOneFileAreTakenApart) {
  // Frame 1 in one fragment, frame 2 in two: the table of offsets says so.
  DicomTestFile frames = multi_frame_file(4, 3, {1.0, 0.0});
  frames.transfer_syntax = "1.2.840.10008.1.2.4.80";
  frames.number(0x00280101, 12);
  frames.number(0x00280102, 11);
  frames.element.erase(0x7FE00010);
  const formats::TestFolder folder;
  fs::create_directories(folder / "s");
  const std::vector<std::string> parts = {kJpegLs, kJpegLs.substr(0, 40), kJpegLs.substr(40)};
  const std::string table =
      DicomTestFile::four_bytes(0) + DicomTestFile::four_bytes(8 + kJpegLs.size());
  formats::write_file(folder / "s/0", frames.bytes() + fragments(table, parts));
  const imaging::Volume image = read_image(folder / "s").image;
  ASSERT_EQ(image.value.size(), 24U);
  for (std::size_t v = 0; v < 24; ++v) {
    EXPECT_EQ(image.value[v], 2.0F * kPixels[v % 12] + 1.0F) << v;  // rescaled
  }
  formats::write_file(folder / "s/0", frames.bytes() + fragments("", parts));
  EXPECT_THAT(formats::message_of<InputError>([&] { read_image(folder / "s"); }),
              HasSubstr("s/0: 3 compressed pieces of 2 frames, without a table"));
}

TEST(DicomCompressed, DamageAndOtherCompressionAreRefusedByName) {
  const auto message = [&](const std::string& syntax, const std::string& packed) {
    return formats::message_of<InputError>([&] {
      read_two(DicomTestFile::slice(2, 2, 0).bytes(), compressed_slice(1.0, syntax, packed));
    });
  };
  EXPECT_THAT(message("1.2.840.10008.1.2.4.100", "abcd"),
              HasSubstr("s/1: is compressed (MPEG-2), which isn't read"));
  EXPECT_THAT(message("1.2.3", "abcd"), HasSubstr("(transfer syntax 1.2.3)"));
  EXPECT_THAT(message(kRle, ""), HasSubstr("s/1: has no compressed pixels"));
  EXPECT_THAT(message(kRle, run_lengths().substr(0, 70)),
              HasSubstr("s/1: its run lengths end too early"));
  for (const char* const syntax :
       {kLosslessJpeg, "1.2.840.10008.1.2.4.80", "1.2.840.10008.1.2.4.90"}) {
    EXPECT_THAT(message(syntax, "abcd"),
                HasSubstr("s/1: its compressed image doesn't begin as JPEG"));
  }
  EXPECT_THAT(message("1.2.840.10008.1.2.4.80", kJpegLs),
              HasSubstr("s/1: its compressed image has 4 x 3 pixels; the file says 2 x 2"));
  EXPECT_THAT(message("1.2.840.10008.1.2.4.90", kJpeg2000), HasSubstr("has 4 x 3 pixels"));
  EXPECT_THAT(message(kLosslessJpeg, jpeg("", 1, bytes_of({0xAC, 0xFF, 0x00, 0x7F}))),
              HasSubstr("has 1 component of 8 bits; the file says 1 of up to 16"));
  const std::string cut = kJpegLs.substr(0, kJpegLs.size() - 20);
  EXPECT_THAT(formats::message_of<InputError>([&] {
                read_two(DicomTestFile::slice(4, 3, 0).bytes(),
                         compressed_pixels(1.0, "1.2.840.10008.1.2.4.80", cut));
              }),
              HasSubstr("s/1: "));
}

TEST(DicomCompressed, AMissingProgramIsNamed) {
  ::setenv("PALMAR_DICOM", "/nowhere/palmar-dicom", 1);
  const std::string message = formats::message_of<formats::ProgramMissing>([] {
    read_two(compressed_pixels(0.0, "1.2.840.10008.1.2.4.80", kJpegLs),
             compressed_pixels(1.0, "1.2.840.10008.1.2.4.80", kJpegLs));
  });
  ::unsetenv("PALMAR_DICOM");
  EXPECT_THAT(message, HasSubstr("/nowhere/palmar-dicom isn't there"));
}

TEST(DicomCompressed, WhatAnotherProgramCompressesReadsBackExactly) {
  if (!formats::find_program("dcmcjpeg") || !formats::find_program("dcmcrle") ||
      !formats::find_program("dcmcjpls")) {
    GTEST_SKIP() << "dcmcjpeg, dcmcrle and dcmcjpls (Debian package dcmtk) aren't installed";
  }
  const formats::TestFolder folder;
  imaging::Volume image;
  image.grid.size = {23, 17, 2};
  std::mt19937 random(1);
  for (std::size_t v = 0; v < image.grid.count(); ++v) {
    image.value.push_back(static_cast<float>(v % 23 * 40 + random() % 300));
  }
  write_dicom_series(folder / "s", image, {});
  const std::vector<std::vector<std::string>> ways = {
      {"dcmcrle"}, {"dcmcjpeg", "+e1"}, {"dcmcjpeg", "+el", "+sv", "7"}, {"dcmcjpls"}};
  for (const auto& way : ways) {
    fs::create_directories(folder / "c");
    for (const std::string slice : {"slice-0001.dcm", "slice-0002.dcm"}) {
      std::vector<std::string> arguments(way.begin() + 1, way.end());
      arguments.push_back("s/" + slice);
      arguments.push_back("c/" + slice);
      ASSERT_EQ(
          formats::run_program(*formats::find_program(way[0]), arguments, folder.path(), "log"), 0);
    }
    EXPECT_EQ(read_image(folder / "c").image.value, image.value) << way.back();
  }
}

TEST(DicomCompressed, FuzzedFilesAreReadOrRefusedByNameSoon) {
  const formats::TestFolder folder;
  fs::create_directories(folder / "s");
  const std::string whole[] = {
      compressed_slice(1.0, kRle, run_lengths()),
      compressed_slice(1.0, kLosslessJpeg, jpeg("", 1, bytes_of({0xAC, 0xFF, 0x00, 0x7F}))),
      compressed_pixels(1.0, "1.2.840.10008.1.2.4.80", kJpegLs),
      compressed_pixels(1.0, "1.2.840.10008.1.2.4.90", kJpeg2000),
      compressed_pixels(1.0, "1.2.840.10008.1.2.4.51", kLossyJpeg)};
  std::mt19937 random(5);
  const auto any = [&](std::size_t below) { return static_cast<std::size_t>(random()) % below; };
  for (std::size_t n = 0; n < 200; ++n) {
    DicomTestFile::slice(n % 5 < 2 ? 2 : 4, n % 5 < 2 ? 2 : 3, 0).write(folder / "s/0");
    std::string bytes = whole[n % 5];
    const std::size_t from = n % 3 == 0 ? 128 : bytes.size() - 110;  // mostly the pixels
    for (std::size_t m = 0; m < 1 + any(3); ++m) {
      bytes[from + any(bytes.size() - from)] = static_cast<char>(any(256));
    }
    if (n % 9 == 0) bytes.resize(any(bytes.size()));
    std::ofstream(folder / "s/1", std::ios::binary) << bytes;
    const auto start = std::chrono::steady_clock::now();
    try {
      EXPECT_LE(read_image(folder / "s").image.value.size(), 24U);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("/s"));
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_LT(taken.count(), 40.0) << "s; the child's limit is 30 s";
  }
}

}  // namespace
}  // namespace palmar::images
