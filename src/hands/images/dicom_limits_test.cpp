// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What compressed files may cost: palmar-dicom itself, and the reader that starts it.
#include <gdcmSequenceOfFragments.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "hands/images/dicom.h"
#include "hands/images/gdcm_test_files.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/child_process.h"
#include "palmar/formats/process/worker.h"
#include "palmar/formats/test_files.h"

namespace palmar::images {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Json = nlohmann::json;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kIsSlow = true;  // the sanitizer reserves terabytes; addresses aren't limited
#else
constexpr bool kIsSlow = false;
#endif

const formats::Worker& dicom_program() {
  static const formats::Worker program = {.program = "palmar-dicom",
                                          .variable = "PALMAR_DICOM",
                                          .name = "the DICOM program",
                                          .crashed = "the decoder crashed",
                                          .reason = "its compressed pixels are damaged"};
  return program;
}

double seconds_of(const std::function<void()>& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A folder with what palmar-dicom is asked: the first frame of a file that GDCM packed.
struct Request {
  formats::WorkerFolder folder;
  std::string text;

  Request(const GdcmImage& image, const std::string& syntax) {
    const auto path = folder.path() / "one.dcm";
    image.write(path);
    gdcm::Reader reader;
    reader.SetFileName(path.c_str());
    EXPECT_TRUE(reader.Read());
    const auto& pixels = reader.GetFile().GetDataSet().GetDataElement(gdcm::Tag(0x7FE0, 0x0010));
    const gdcm::ByteValue* piece = pixels.GetSequenceOfFragments()->GetFragment(0).GetByteValue();
    stream.assign(piece->GetPointer(), piece->GetLength());
    ask(image.columns, image.rows, syntax);
  }
  void ask(int columns, int rows, const std::string& syntax) {
    formats::write_file(folder.path() / "packed.bin", stream);
    const Json frame = {{"name", "one.dcm"}, {"bytes", stream.size()}, {"columns", columns},
                        {"rows", rows},      {"bits_allocated", 16},   {"bits_stored", 12},
                        {"high_bit", 11},    {"is_signed", false}};
    text = Json{{"transfer_syntax", syntax}, {"frames", Json::array({frame})}}.dump();
  }
  /// What becomes of it within these limits; "" if the frame is unpacked.
  std::string message(const formats::WorkerLimits& limits) const {
    return formats::message_of<InputError>(
        [&] { formats::run_worker(dicom_program(), "unpack", text, folder, "one.dcm", limits); });
  }
  /// Exit code of the program alone.
  formats::ChildResult result(const formats::ChildLimits& limits) const {
    formats::write_file(folder.path() / "request.json", text);
    return formats::run_child(formats::program_of(dicom_program()),
                              {"unpack", folder.path().string()}, folder.path() / "log", limits, {},
                              {});
  }

  std::string stream;
};

constexpr const char* kJpeg2000Syntax = "1.2.840.10008.1.2.4.90";
constexpr const char* kJpegLsSyntax = "1.2.840.10008.1.2.4.80";

GdcmImage one_frame(int columns, int rows, gdcm::TransferSyntax::TSType syntax) {
  GdcmImage image;
  image.columns = columns;
  image.rows = rows;
  image.frames = 1;
  image.syntax = syntax;
  return image;
}

TEST(DicomLimits, TheProgramSaysByItsExitCodeWhatHappened) {
  const auto run = [](const std::vector<std::string>& arguments) {
    const formats::TestFolder folder;
    return formats::run_child(formats::program_of(dicom_program()), arguments, folder / "log", {},
                              {}, {})
        .code;
  };
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({"pack", "/tmp"}), 2);
  Request request(one_frame(37, 29, gdcm::TransferSyntax::JPEGLSLossless), kJpegLsSyntax);
  EXPECT_EQ(request.result({}).code, 0);
  EXPECT_EQ(std::filesystem::file_size(request.folder.path() / "pixels.bin"), 37U * 29U * 2U);
  request.stream.erase(request.stream.size() / 2, request.stream.size() / 4);
  request.ask(37, 29, kJpegLsSyntax);
  EXPECT_EQ(request.result({}).code, 3);
  const Json error = Json::parse(formats::read_file(request.folder.path() / "error.json"));
  EXPECT_THAT(error.at("message").get<std::string>(),
              StartsWith("one.dcm: its compressed image is damaged"));
  EXPECT_EQ(error.at("exit_code"), 3);
  request.text = "{";
  EXPECT_EQ(request.result({}).code, 1);
}

TEST(DicomLimits, TimeIsKept) {
  // 4 million pixels of JPEG 2000 take GDCM seconds.
  const Request request(one_frame(2000, 2000, gdcm::TransferSyntax::JPEG2000Lossless),
                        kJpeg2000Syntax);
  std::string message;
  const double taken = seconds_of(
      [&] { message = request.message({.seconds = 0.1, .memory_mb = 4096.0, .is_fixed = true}); });
  EXPECT_EQ(message, "one.dcm: took longer than 0.1 s of processor time, the limit");
  EXPECT_LT(taken, 5.0) << "s; the wait is looked at every 20 ms";
  EXPECT_FALSE(std::filesystem::exists(request.folder.path() / "reply.json"));
}

TEST(DicomLimits, AStreamThatIsCutOffDoesNotKeepTheDecoderBusyForEver) {
  // The first 100 bytes of JPEG-LS: GDCM 3.0.21 (CharLS 2.4.1) is still at it after minutes.
  const formats::TestFolder folder;
  GdcmImage image = one_frame(256, 256, gdcm::TransferSyntax::JPEGLSLossless);
  Request request(image, kJpegLsSyntax);
  request.stream.resize(100);
  request.ask(256, 256, kJpegLsSyntax);
  std::string message;
  const double taken = seconds_of(
      [&] { message = request.message({.seconds = 1.0, .memory_mb = 1024.0, .is_fixed = true}); });
  EXPECT_THAT(message, AnyOf("one.dcm: took longer than 1 s of processor time, the limit",
                             HasSubstr("one.dcm: its compressed image is damaged")));
  EXPECT_LT(taken, 5.0);
  // The reader doesn't let it come that far: each stream has to have its end marker.
  image.frames = 2;
  image.write(folder / "one.dcm");
  std::string bytes = formats::read_file(folder / "one.dcm");
  const std::size_t end = bytes.find("\xFF\xD9");
  ASSERT_NE(end, std::string::npos);
  bytes[end + 1] = '\x12';
  formats::write_file(folder / "one.dcm", bytes);
  EXPECT_THAT(formats::message_of<InputError>([&] { read_image(folder / "one.dcm"); }),
              HasSubstr("one.dcm (frame 1): its compressed image is cut off: the end marker is "
                        "missing"));
}

TEST(DicomLimits, MemoryIsKept) {
  // 64 million pixels need 128 MB as they are and 256 MB within OpenJPEG.
  Request request(one_frame(64, 64, gdcm::TransferSyntax::JPEG2000Lossless), kJpeg2000Syntax);
  for (std::size_t at : {std::size_t{8}, std::size_t{12}, std::size_t{24}, std::size_t{28}}) {
    request.stream.replace(at, 4, std::string("\x00\x00\x1F\x40", 4));  // 8000
  }
  request.ask(8000, 8000, kJpeg2000Syntax);
  std::string message;
  const double taken = seconds_of(
      [&] { message = request.message({.seconds = 60.0, .memory_mb = 256.0, .is_fixed = true}); });
  EXPECT_THAT(message, AnyOf(HasSubstr("one.dcm: needs more than 256 MB of memory, the limit"),
                             HasSubstr("one.dcm: its compressed image is damaged")));
  EXPECT_LT(taken, 30.0);
  if (!kIsSlow) {
    EXPECT_LE(request.result({.memory_mb = 256.0}).peak_memory_mb, 256.0);
    EXPECT_GT(request.result({.memory_mb = 4096.0}).peak_memory_mb, 256.0);  // it wants more
  }
}

/// What reading a file says; reading has to end within `seconds`.
std::string message_within(double seconds, const std::filesystem::path& path) {
  std::string message;
  const double taken =
      seconds_of([&] { message = formats::message_of<InputError>([&] { read_image(path); }); });
  EXPECT_LT(taken, seconds) << "s: " << message;
  return message;
}

TEST(DicomLimits, ASmallFileThatClaimsAnEnormousImageIsRefusedAtOnce) {
  for (const auto syntax :
       {gdcm::TransferSyntax::JPEG2000Lossless, gdcm::TransferSyntax::JPEGLSLossless}) {
    const formats::TestFolder folder;
    GdcmImage image = one_frame(64, 48, syntax);
    image.frames = 2;
    image.write(folder / "one.dcm");
    const std::string whole = formats::read_file(folder / "one.dcm");
    const auto message_with = [&](const std::string& bytes) {
      formats::write_file(folder / "one.dcm", bytes);
      return message_within(10.0, folder / "one.dcm");
    };
    EXPECT_THAT(message_with(claiming_size(whole, 65535, 65535)),
                HasSubstr("one.dcm: 65535 x 65535 x 2 voxels need 34.4 GB; up to 2.1 GB are read"));
    EXPECT_THAT(message_with(claiming_size(whole, 16000, 16000)),
                AllOf(HasSubstr("one.dcm: says it has 512 million pixels in "),
                      HasSubstr("compressed bytes; up to 1000 pixels for a byte are read")));
    formats::write_file(folder / "one.dcm", whole);
    make_old_style(folder / "one.dcm", {{0x00200032, "0\\0\\0"},
                                        {0x00200037, "1\\0\\0\\0\\1\\0"},
                                        {0x00280030, "1\\1"},
                                        {0x00180088, "1"}});
    change_with_gdcm(folder / "one.dcm", [](gdcm::DataSet& data) {
      GdcmImage::set_text(data, 0x00280008, "IS", "20000");
    });
    EXPECT_THAT(message_within(10.0, folder / "one.dcm"),
                HasSubstr("one.dcm: 2 compressed pieces of 20000 frames, without a table"));
  }
}

TEST(DicomLimits, AClaimJustBelowTheBoundCostsLittle) {
  // 2 x 2800 x 2800 pixels, 63 MB as numbers: small enough to be tried.
  for (const auto& [name, syntax] : packed_syntaxes()) {
    if (name != "JPEG-LS" && name != "JPEG 2000") continue;
    const formats::TestFolder folder;
    GdcmImage image = one_frame(64, 48, syntax);
    image.frames = 2;
    image.write(folder / "one.dcm");
    formats::write_file(folder / "one.dcm",
                        claiming_size(formats::read_file(folder / "one.dcm"), 2800, 2800));
    EXPECT_THAT(message_within(kIsSlow ? 120.0 : 30.0, folder / "one.dcm"),
                AnyOf("", HasSubstr("one.dcm")))
        << name;
  }
}

TEST(DicomLimits, CutAndFlippedFilesAreReadOrRefusedByNameSoon) {
  std::mt19937 random(11);
  const auto any = [&](std::size_t below) { return static_cast<std::size_t>(random()) % below; };
  for (const auto& [name, syntax] : packed_syntaxes()) {
    const formats::TestFolder folder;
    GdcmImage image;
    image.columns = 64;
    image.rows = 48;
    image.frames = 3;
    image.syntax = syntax;
    image.write(folder / "one.dcm");
    const std::string whole = formats::read_file(folder / "one.dcm");
    const std::size_t pixels = whole.find(std::string("\xE0\x7F\x10\x00OB", 6));
    ASSERT_NE(pixels, std::string::npos);
    int refused = 0;
    for (int n = 0; n < (kIsSlow ? 10 : 40); ++n) {
      std::string bytes = whole;
      for (std::size_t m = 0; m < 1 + any(4); ++m) {
        char& byte = bytes[pixels + any(bytes.size() - pixels)];
        byte = static_cast<char>(byte ^ 1 << any(8));
      }
      if (n % 4 == 0) {  // a fragment that ends early, with the delimiter behind it
        const std::size_t length = 8 + any(200);
        bytes = whole.substr(0, whole.size() - 8 - length) + std::string(length, '\0') +
                whole.substr(whole.size() - 8);
      }
      if (n % 4 == 1) bytes.resize(pixels + any(bytes.size() - pixels));
      formats::write_file(folder / "one.dcm", bytes);
      const std::string message = message_within(60.0, folder / "one.dcm");
      EXPECT_THAT(message, AnyOf("", HasSubstr("one.dcm"))) << name;
      refused += message.empty() ? 0 : 1;
    }
    EXPECT_GE(refused, kIsSlow ? 2 : 10) << name;  // the cut ones at least
  }
}

}  // namespace
}  // namespace palmar::images
