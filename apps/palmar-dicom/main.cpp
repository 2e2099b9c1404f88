// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// palmar-dicom unpack FOLDER: unpacks compressed DICOM pixels with GDCM as FOLDER/request.json asks
// and leaves FOLDER/reply.json, or FOLDER/error.json and Palmar's exit code. Started by Palmar
// (hands/images/dicom_compressed.h), not by people. GDCM sees compressed pixels only, never a
// whole file: Palmar reads the attributes itself.
//
// {transfer_syntax, frames: [{name, bytes, columns, rows, bits_allocated, bits_stored,
// is_signed}]},
//   packed.bin (the frames' bytes, one behind the other) -> pixels.bin: the frames as an
//   uncompressed file has them, little-endian, row by row.
#include <gdcmDataElement.h>
#include <gdcmFragment.h>
#include <gdcmImage.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTag.h>
#include <gdcmTrace.h>
#include <gdcmTransferSyntax.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <new>
#include <string>
#include <string_view>

#include "../worker/worker_main.h"
#include "hands/images/dicom_slice.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/worker.h"

#ifdef __SANITIZE_ADDRESS__
// GDCM forgets the memory of a stream that it gives up on; the process ends right after. Nobody
// else's leaks are passed over.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions() { return "leak:libgdcm"; }
#endif

namespace {

namespace fs = std::filesystem;
using palmar::InputError;
using palmar::Progress;
using palmar::worker::Json;

std::string unpacked(const Json& frame, gdcm::TransferSyntax syntax, std::string_view packed) {
  const auto name = frame.at("name").get<std::string>();
  const auto columns = frame.at("columns").get<unsigned int>();
  const auto rows = frame.at("rows").get<unsigned int>();
  const auto bits = frame.at("bits_allocated").get<std::uint16_t>();
  const auto stored = frame.at("bits_stored").get<std::uint16_t>();
  palmar::images::check_image_size(name, columns, rows, 1.0);

  gdcm::Image image;
  image.SetTransferSyntax(syntax);
  image.SetNumberOfDimensions(2);
  const unsigned int size[] = {columns, rows, 1};
  image.SetDimensions(size);
  image.SetPixelFormat(gdcm::PixelFormat(1, bits, stored, frame.at("high_bit").get<std::uint16_t>(),
                                         frame.at("is_signed").get<bool>() ? 1 : 0));
  image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  gdcm::Fragment fragment;
  fragment.SetByteValue(packed.data(), gdcm::VL(static_cast<std::uint32_t>(packed.size())));
  const gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments = new gdcm::SequenceOfFragments;
  fragments->AddFragment(fragment);
  gdcm::DataElement pixels(gdcm::Tag(0x7FE0, 0x0010));
  pixels.SetVR(gdcm::VR::OB);
  pixels.SetValue(*fragments);
  image.SetDataElement(pixels);

  const std::size_t needed = std::size_t{columns} * rows * (bits / 8);
  if (image.GetBufferLength() != needed)
    throw InputError(name + ": its compressed image has another size");
  std::string bytes(needed, '\0');
  bool is_unpacked = false;
  try {
    is_unpacked = image.GetBuffer(bytes.data());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // of the standard library within a decoder
    throw InputError(name + ": its compressed image is damaged: " + error.what());
  }
  if (!is_unpacked) {
    throw InputError(name + ": its compressed image is damaged, cut off or of another size");
  }
  return bytes;
}

Json unpack(const Json& request, const fs::path& folder, const Progress& progress) {
  const auto syntax =
      gdcm::TransferSyntax::GetTSType(request.at("transfer_syntax").get<std::string>().c_str());
  if (syntax == gdcm::TransferSyntax::TS_END) throw InputError("the transfer syntax isn't known");
  const std::string packed = palmar::formats::read_file(folder / "packed.bin");
  std::string_view rest = packed;
  std::string pixels;
  const Json& frames = request.at("frames");
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const auto bytes = frames[f].at("bytes").get<std::size_t>();
    if (bytes > rest.size()) throw InputError("packed.bin: too short");
    progress.update(static_cast<double>(f) / static_cast<double>(frames.size()),
                    "unpacking " + frames[f].at("name").get<std::string>());
    pixels += unpacked(frames[f], gdcm::TransferSyntax(syntax), rest.substr(0, bytes));
    rest.remove_prefix(bytes);
  }
  palmar::formats::write_file(folder / "pixels.bin", pixels);
  return palmar::worker::Json::object();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 || std::string_view(argv[1]) != "unpack") {
    std::fprintf(stderr, "palmar-dicom is started by palmar-hands; see `palmar mri -h`\n");
    return 2;
  }
  gdcm::Trace::SetWarning(false);
  gdcm::Trace::SetError(false);
  gdcm::Trace::SetDebug(false);
  return palmar::worker::answer(argv[2], unpack);
}
