// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gdcmAttribute.h>
#include <gdcmImage.h>
#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageWriter.h>
#include <gdcmMediaStorage.h>
#include <gdcmReader.h>
#include <gdcmTrace.h>
#include <gdcmTransferSyntax.h>
#include <gdcmWriter.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace palmar::images {

/// Stored value of 12 bits of a test image: a slope with a pattern on it.
inline std::uint16_t formula_value(int i, int j, int k) {
  return static_cast<std::uint16_t>((37 * i + 101 * j + 613 * k + i * j % 97) % 4096);
}

/// A multi-frame image that GDCM packs and writes as an enhanced MR file: nothing of Palmar's takes
/// part.
struct GdcmImage {
  int columns = 37, rows = 29, frames = 5;
  gdcm::TransferSyntax::TSType syntax = gdcm::TransferSyntax::ExplicitVRLittleEndian;
  std::array<double, 3> origin = {-10, 20, 5};          ///< mm
  std::array<double, 3> spacing = {0.25, 0.5, 1.5};     ///< mm, along i, j and k
  std::array<double, 6> cosines = {0, 1, 0, 0, 0, -1};  ///< k along -x
  double slope = 2.0, intercept = 1.0;
  gdcm::PixelFormat format = gdcm::PixelFormat(1, 16, 12, 11, 0);
  std::function<std::uint16_t(int, int, int)> value = formula_value;  ///< stored, at i, j, k

  void write(const std::filesystem::path& path) const {
    gdcm::Trace::SetWarning(false);
    gdcm::Trace::SetError(false);
    std::filesystem::create_directories(path.parent_path());
    const gdcm::SmartPointer<gdcm::Image> image = new gdcm::Image;
    fill(*image);
    gdcm::ImageChangeTransferSyntax packing;
    packing.SetTransferSyntax(syntax);
    packing.SetInput(*image);
    const bool is_packed = syntax != gdcm::TransferSyntax::ExplicitVRLittleEndian;
    if (is_packed && !packing.Change()) throw std::runtime_error("GDCM can't pack the image");
    gdcm::ImageWriter writer;
    gdcm::DataSet& data = writer.GetFile().GetDataSet();
    set_text(data, 0x00080016, "UI",
             gdcm::MediaStorage::GetMSString(gdcm::MediaStorage::EnhancedMRImageStorage));
    set_text(data, 0x00080060, "CS", "MR");
    set_text(data, 0x0008103E, "LO", "reference");
    set_text(data, 0x00200011, "IS", "4");
    writer.SetFileName(path.c_str());
    writer.SetImage(is_packed ? packing.GetOutput() : *image);
    if (!writer.Write()) throw std::runtime_error("GDCM can't write " + path.string());
  }

  static void set_text(gdcm::DataSet& data, std::uint32_t tag, const char* vr, std::string text) {
    if (text.size() % 2 != 0) text += std::string(vr) == "UI" ? '\0' : ' ';
    gdcm::DataElement element{gdcm::Tag(tag)};
    element.SetVR(gdcm::VR::GetVRType(vr));
    element.SetByteValue(text.data(), gdcm::VL(static_cast<std::uint32_t>(text.size())));
    data.Replace(element);
  }

 private:
  void fill(gdcm::Image& image) const {
    std::string bytes;
    for (int k = 0; k < frames; ++k) {
      for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
          const std::uint16_t stored = value(i, j, k);
          bytes += static_cast<char>(stored & 0xFF);
          bytes += static_cast<char>(stored >> 8);
        }
      }
    }
    image.SetNumberOfDimensions(3);
    const unsigned int size[] = {static_cast<unsigned int>(columns),
                                 static_cast<unsigned int>(rows),
                                 static_cast<unsigned int>(frames)};
    image.SetDimensions(size);
    image.SetPixelFormat(format);
    image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
    image.SetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
    image.SetOrigin(origin.data());
    image.SetSpacing(spacing.data());
    image.SetDirectionCosines(cosines.data());
    image.SetSlope(slope);
    image.SetIntercept(intercept);
    gdcm::DataElement pixels(gdcm::Tag(0x7FE0, 0x0010));
    pixels.SetVR(gdcm::VR::OW);
    pixels.SetByteValue(bytes.data(), gdcm::VL(static_cast<std::uint32_t>(bytes.size())));
    image.SetDataElement(pixels);
  }
};

/// Lets `change` alter the attributes of a DICOM file, which GDCM reads and writes.
inline void change_with_gdcm(const std::filesystem::path& path,
                             const std::function<void(gdcm::DataSet&)>& change) {
  gdcm::Reader reader;
  reader.SetFileName(path.c_str());
  if (!reader.Read()) throw std::runtime_error("GDCM can't read " + path.string());
  change(reader.GetFile().GetDataSet());
  gdcm::Writer writer;
  writer.SetFile(reader.GetFile());
  writer.SetFileName(path.c_str());
  if (!writer.Write()) throw std::runtime_error("GDCM can't write " + path.string());
}

/// Makes an enhanced file one of the old style: no functional groups, the first frame's place only.
inline void make_old_style(const std::filesystem::path& path,
                           const std::vector<std::pair<std::uint32_t, std::string>>& decimals) {
  change_with_gdcm(path, [&](gdcm::DataSet& data) {
    data.Remove(gdcm::Tag(0x5200, 0x9229));
    data.Remove(gdcm::Tag(0x5200, 0x9230));
    GdcmImage::set_text(data, 0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.4");
    for (const auto& [tag, text] : decimals) GdcmImage::set_text(data, tag, "DS", text);
  });
}

/// The syntaxes that GDCM packs without loss.
inline const std::vector<std::pair<std::string, gdcm::TransferSyntax::TSType>>& packed_syntaxes() {
  static const std::vector<std::pair<std::string, gdcm::TransferSyntax::TSType>> all = {
      {"JPEG-LS", gdcm::TransferSyntax::JPEGLSLossless},
      {"JPEG 2000", gdcm::TransferSyntax::JPEG2000Lossless},
      {"lossless JPEG", gdcm::TransferSyntax::JPEGLosslessProcess14_1},
      {"run lengths", gdcm::TransferSyntax::RLELossless}};
  return all;
}

/// Lets a file of JPEG-LS or JPEG 2000 frames claim another size: in its attributes and in the head
/// of every stream (ITU-T T.87, C.2.2; T.800, A.5.1). No byte is added.
inline std::string claiming_size(std::string file, std::uint32_t columns, std::uint32_t rows) {
  const auto put = [&](std::size_t at, std::uint32_t value, std::size_t bytes, bool is_big) {
    for (std::size_t b = 0; b < bytes; ++b) {
      file.at(at + (is_big ? bytes - 1 - b : b)) = static_cast<char>(value >> 8 * b & 0xFF);
    }
  };
  put(file.find(std::string("\x28\x00\x10\x00US", 6)) + 8, rows, 2, false);
  put(file.find(std::string("\x28\x00\x11\x00US", 6)) + 8, columns, 2, false);
  const auto each = [&](const char* head, const auto& change) {
    for (std::size_t at = file.find(head); at != std::string::npos; at = file.find(head, at + 1)) {
      change(at);
    }
  };
  each("\xFF\x4F\xFF\x51", [&](std::size_t at) {
    for (const std::size_t field : {std::size_t{8}, std::size_t{24}}) {  // image, tile
      put(at + field, columns, 4, true);
      put(at + field + 4, rows, 4, true);
    }
  });
  each("\xFF\xD8\xFF\xF7", [&](std::size_t at) {
    put(at + 7, rows, 2, true);
    put(at + 9, columns, 2, true);
  });
  return file;
}

}  // namespace palmar::images
