// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/motion/c3d.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <random>

#include "palmar/core/error.h"
#include "palmar/formats/motion/c3d_test_file.h"

namespace palmar::formats {
namespace {

using ::testing::HasSubstr;
using Processor = C3dTestFile::Processor;

C3dTestFile sample() {
  C3dTestFile file;
  file.labels = {"index_nail", "thumb_nail", "third_metacarpal_base"};
  for (int f = 0; f < 5; ++f) {
    const auto v = static_cast<float>(f);
    file.frames.push_back({{100.25F + v, -20.5F, 1000.0F}, {1.5F, 2.5F, -3.5F - v}, {7, 8, 9}});
  }
  file.frames[3][1].is_seen = false;
  return file;
}

std::string c3d_message(const std::string& bytes) {
  try {
    parse_c3d(bytes, "take.c3d");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(C3d, EveryProcessorAndNumberFormatReadsAlike) {
  for (const Processor processor : {Processor::kIntel, Processor::kDec, Processor::kMips}) {
    for (const bool is_float : {true, false}) {
      for (const int analog : {0, 3}) {
        C3dTestFile file = sample();
        file.processor = processor;
        file.is_float = is_float;
        file.analog_per_frame = analog;
        file.first_frame = 12;
        const MarkerRecording read = parse_c3d(file.bytes(), "take.c3d");
        SCOPED_TRACE(read.format);
        EXPECT_EQ(read.labels, file.labels);
        EXPECT_TRUE(read.notes.empty());
        ASSERT_EQ(read.frames.size(), 5U);
        EXPECT_EQ(read.frames[0].number, 12);
        EXPECT_NEAR(*read.frames[4].time, 0.04, 1e-12);
        // Integers count in units of the scale, 0.05 mm.
        const double tolerance = is_float ? 1e-6 : 0.0251;
        for (std::size_t f = 0; f < 5; ++f) {
          for (std::size_t i = 0; i < 3; ++i) {
            const C3dTestFile::Point& p = file.frames[f][i];
            ASSERT_EQ(read.frames[f].position[i].has_value(), p.is_seen);
            if (!p.is_seen) continue;
            EXPECT_LT((*read.frames[f].position[i] - Vec3(p.x, p.y, p.z)).norm(), 2 * tolerance);
          }
        }
      }
    }
  }
}

TEST(C3d, DecFloatsAreThoseOfTheSpecification) {
  // VAX F floating: 1.0 is the bytes 80 40 00 00; -12.5 is 48 C2 00 00 (VAX Architecture
  // Reference).
  C3dTestFile file = sample();
  file.processor = Processor::kDec;
  file.frames = {{{1.0F, -12.5F, 0.0F}, {1, 1, 1}, {1, 1, 1}}};
  const std::string bytes = file.bytes();
  const std::string expected("\x80\x40\x00\x00\x48\xC2\x00\x00", 8);
  EXPECT_NE(bytes.find(expected), std::string::npos);
  EXPECT_EQ(*parse_c3d(bytes, "x").frames[0].position[0], Vec3(1.0, -12.5, 0.0));
}

TEST(C3d, UnitsComeFromTheFileOrTheUser) {
  C3dTestFile file = sample();
  file.unit = "m";
  EXPECT_NEAR(parse_c3d(file.bytes(), "x").frames[0].position[0]->x(), 100250, 1e-6);
  EXPECT_NEAR(
      parse_c3d(file.bytes(), "x", geometry::LengthUnit::kCentimetre).frames[0].position[0]->x(),
      1002.5, 1e-6);
  file.unit = "ell";
  EXPECT_THAT(c3d_message(file.bytes()), HasSubstr("\"ell\""));
  EXPECT_THAT(c3d_message(file.bytes()), HasSubstr("setting \"unit\""));
  EXPECT_NO_THROW(parse_c3d(file.bytes(), "x", geometry::LengthUnit::kMillimetre));
}

TEST(C3d, MoreThan255LabelsGoOnInTheNextParameter) {
  C3dTestFile file;
  file.labels_per_parameter = 200;
  for (int i = 0; i < 430; ++i) file.labels.push_back("marker_" + std::to_string(i));
  file.frames.assign(2, std::vector<C3dTestFile::Point>(430, {1, 2, 3}));
  const MarkerRecording read = parse_c3d(file.bytes(), "x");
  EXPECT_EQ(read.labels, file.labels);
}

TEST(C3d, WhatIsDoubtfulIsNoted) {
  C3dTestFile file = sample();
  file.promised_frames = 100;
  MarkerRecording read = parse_c3d(file.bytes(), "x");
  // The last block is filled up with zeros, in which some more frames seem to stand.
  EXPECT_LT(read.frames.size(), 20U);
  EXPECT_THAT(read.notes, testing::Contains(HasSubstr("promises 100 frames")));
  file = sample();
  file.labels[2] = file.labels[0];
  read = parse_c3d(file.bytes(), "x");
  EXPECT_THAT(read.notes, testing::Contains(HasSubstr("appears twice")));
  EXPECT_NE(read.labels[2], read.labels[0]);
  file = sample();
  file.frames[1][0] = {0, 0, 0};
  file.frames[2][0].x = std::nanf("");
  read = parse_c3d(file.bytes(), "x");
  EXPECT_FALSE(read.frames[1].position[0]);
  EXPECT_FALSE(read.frames[2].position[0]);
  EXPECT_EQ(read.notes.size(), 2U);
}

TEST(C3d, BrokenFilesAreRefusedWithTheByte) {
  const std::string whole = sample().bytes();
  EXPECT_THAT(c3d_message("no C3D"), HasSubstr("take.c3d: byte 0: no C3D header"));
  EXPECT_THAT(c3d_message(whole.substr(0, 1024)), HasSubstr("the file ends within"));
  std::string processor = whole;
  processor[515] = 12;
  EXPECT_THAT(c3d_message(processor), HasSubstr("byte 515: processor type 12"));
  std::string empty = whole;
  empty[2] = 0;
  EXPECT_THAT(c3d_message(empty), HasSubstr("no 3D points"));
  std::string no_data = whole;
  no_data[16] = no_data[17] = 0;
  EXPECT_THAT(c3d_message(no_data), HasSubstr("start of the data"));
}

TEST(C3d, MutatedFilesNeitherCrashNorHang) {
  std::mt19937 random(11);
  const auto start = std::chrono::steady_clock::now();
  int refused = 0;
  constexpr int kFiles = 6000;
  for (int k = 0; k < kFiles; ++k) {
    C3dTestFile file = sample();
    file.processor = static_cast<Processor>(84 + k % 3);
    file.is_float = k % 2 == 0;
    std::string bytes = file.bytes();
    const int changes = 1 + static_cast<int>(random() % 8);
    for (int c = 0; c < changes; ++c) {
      // Header and parameters hold what a reader follows.
      const std::size_t reach =
          random() % 4 == 0 ? bytes.size() : std::min<std::size_t>(900, bytes.size());
      bytes[random() % reach] = static_cast<char>(random() % 256);
    }
    if (random() % 5 == 0) bytes.resize(random() % bytes.size());
    try {
      const MarkerRecording read = parse_c3d(bytes, "x");
      std::size_t positions = 0;
      for (const auto& frame : read.frames) {
        ASSERT_EQ(frame.position.size(), read.labels.size());
        positions += frame.position.size();
        for (const auto& one : frame.position) {
          if (one) {
            ASSERT_TRUE(one->allFinite());
          }
        }
      }
      ASSERT_LE(positions, bytes.size() / 8);  // no more than the file can hold
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, kFiles / 20);
  EXPECT_LT(refused, kFiles);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

}  // namespace
}  // namespace palmar::formats
