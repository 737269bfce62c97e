#include <fmt/format.h>
#include <gdcm-3.0/gdcmAttribute.h>
#include <gdcm-3.0/gdcmImageReader.h>
#include <gdcm-3.0/gdcmReader.h>
#include <gdcm-3.0/gdcmTrace.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>

#include "core/base/error.h"
#include "core/base/files/file_text.h"
#include "core/bone/data/read_volume_internal.h"

namespace haptrial::bone {
namespace fs = std::filesystem;
namespace {

/// What a file says of its slice, in millimetres.
struct Slice {
  fs::path file;
  std::string series;
  std::string modality;
  int rows{0};
  int columns{0};
  int frames{1};
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};
  Eigen::Vector3d along_row{Eigen::Vector3d::Zero()};     // where columns count up
  Eigen::Vector3d along_column{Eigen::Vector3d::Zero()};  // where rows count up
  Eigen::Vector2d spacing{Eigen::Vector2d::Zero()};       // between rows, between columns
  bool placed{false};
  bool whole{true};  // as far as its size says
};

/// Whether the pixels have room behind their tag; unknown where they are compressed.
bool is_whole(const gdcm::Reader& reader, const Slice& slice, int bits) {
  const gdcm::TransferSyntax& syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
  if (syntax.IsEncapsulated() || syntax == gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian) {
    return true;
  }
  const double pixels = static_cast<double>(slice.rows) * slice.columns * slice.frames;
  const double head = static_cast<double>(fs::file_size(slice.file)) - pixels * bits / 8.0 - 8.0;
  constexpr double kLargest = 1e8;
  if (!(head >= 0.0 && head <= kLargest)) {
    return head > 0.0;
  }
  const std::string bytes = file_head(slice.file, static_cast<std::size_t>(head) + 4);
  constexpr std::string_view kTag("\xE0\x7F\x10\x00", 4);
  constexpr std::string_view kBigEndianTag("\x7F\xE0\x00\x10", 4);
  return bytes.find(kTag) != std::string::npos || bytes.find(kBigEndianTag) != std::string::npos;
}

template <class Attribute>
std::optional<Attribute> find(const gdcm::DataSet& data) {
  Attribute attribute;
  if (!data.FindDataElement(attribute.GetTag())) {
    return std::nullopt;
  }
  const gdcm::DataElement& element = data.GetDataElement(attribute.GetTag());
  if (element.IsEmpty()) {
    return std::nullopt;
  }
  attribute.SetFromDataElement(element);
  return attribute;
}

std::string text(const char* value) {
  std::string words = value == nullptr ? "" : value;
  while (!words.empty() && (words.back() == ' ' || words.back() == '\0')) {
    words.pop_back();
  }
  return words;
}

/// Nothing where the file is not an image in DICOM format.
std::optional<Slice> read_slice(const fs::path& file) {
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  if (!reader.CanRead() || !reader.ReadUpToTag(gdcm::Tag(0x7fe0, 0x0010))) {
    return std::nullopt;
  }
  const gdcm::DataSet& data = reader.GetFile().GetDataSet();
  Slice slice;
  slice.file = file;
  const auto rows = find<gdcm::Attribute<0x0028, 0x0010>>(data);
  const auto columns = find<gdcm::Attribute<0x0028, 0x0011>>(data);
  if (!rows || !columns) {
    return std::nullopt;
  }
  slice.rows = rows->GetValue();
  slice.columns = columns->GetValue();
  if (const auto series = find<gdcm::Attribute<0x0020, 0x000e>>(data)) {
    slice.series = text(series->GetValue());
  }
  if (const auto modality = find<gdcm::Attribute<0x0008, 0x0060>>(data)) {
    slice.modality = text(modality->GetValue().c_str());
  }
  if (const auto frames = find<gdcm::Attribute<0x0028, 0x0008>>(data)) {
    slice.frames = frames->GetValue();
  }
  const auto place = find<gdcm::Attribute<0x0020, 0x0032>>(data);
  const auto turned = find<gdcm::Attribute<0x0020, 0x0037>>(data);
  const auto spacing = find<gdcm::Attribute<0x0028, 0x0030>>(data);
  const auto bits = find<gdcm::Attribute<0x0028, 0x0100>>(data);
  slice.whole = !bits || is_whole(reader, slice, bits->GetValue());
  slice.placed = place && turned && spacing;
  if (slice.placed) {
    for (unsigned i = 0; i < 3; ++i) {
      slice.place[i] = place->GetValue(i);
      slice.along_row[i] = turned->GetValue(i);
      slice.along_column[i] = turned->GetValue(i + 3);
    }
    slice.spacing = {spacing->GetValue(0), spacing->GetValue(1)};
  }
  return slice;
}

std::vector<Slice> slices_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files.push_back(entry.path());
    }
  }
  std::ranges::sort(files);
  std::vector<Slice> slices;
  for (const fs::path& file : files) {
    if (auto slice = read_slice(file)) {
      slices.push_back(std::move(*slice));
    }
  }
  if (slices.empty()) {
    throw InputError(fmt::format(
        "{}: none of its {} files is an image in DICOM format; choose a folder with one series",
        folder.string(), files.size()));
  }
  return slices;
}

/// @throws InputError unless all slices are of one series and alike.
void check_alike(const std::string& name, const std::vector<Slice>& slices) {
  std::set<std::string> series;
  for (const Slice& slice : slices) {
    series.insert(slice.series);
  }
  if (series.size() > 1) {
    throw InputError(
        fmt::format("{}: holds {} series ({} and {}); give each series a folder of its own", name,
                    series.size(), *series.begin(), *series.rbegin()));
  }
  constexpr double kSame = 1e-3;
  const Slice& first = slices.front();
  for (const Slice& slice : slices) {
    const std::string file = slice.file.filename().string();
    if (!slice.whole) {
      throw InputError(fmt::format("{}: {} is incomplete; copy it again", name, file));
    }
    if (!slice.placed) {
      throw InputError(
          fmt::format("{}: {} does not give the place of its slice; every file needs position, "
                      "orientation and pixel spacing",
                      name, file));
    }
    if (slice.rows != first.rows || slice.columns != first.columns ||
        !((slice.spacing - first.spacing).norm() < kSame * first.spacing.norm()) ||
        !((slice.along_row - first.along_row).norm() < kSame) ||
        !((slice.along_column - first.along_column).norm() < kSame)) {
      throw InputError(
          fmt::format("{}: {} has another size or orientation than {}; keep only slices of one "
                      "series in the folder",
                      name, file, first.file.filename().string()));
    }
  }
  if (slices.size() < 2) {
    throw InputError(fmt::format("{}: has 1 slice; allowed: 2 or more", name));
  }
}

/// Sorts slices from the first to the last along their normal.
/// @returns the step from one to the next [mm]. @throws InputError where one is missing or twice.
Eigen::Vector3d order(const std::string& name, std::vector<Slice>& slices) {
  const Eigen::Vector3d normal = slices[0].along_row.cross(slices[0].along_column).normalized();
  std::ranges::sort(slices, {}, [&](const Slice& slice) { return slice.place.dot(normal); });
  std::vector<double> gaps;
  for (std::size_t i = 1; i < slices.size(); ++i) {
    gaps.push_back((slices[i].place - slices[i - 1].place).dot(normal));
  }
  std::vector<double> sorted = gaps;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    constexpr double kPlay = 0.1;  // of a gap
    if (!(std::abs(gaps[i] - usual) <= kPlay * usual)) {
      throw InputError(
          fmt::format("{}: {} and {} lie {:.4g} mm apart, most slices {:.4g} mm; export the series "
                      "again without missing or repeated slices",
                      name, slices[i].file.filename().string(),
                      slices[i + 1].file.filename().string(), gaps[i], usual));
    }
  }
  return (slices.back().place - slices.front().place) / static_cast<double>(gaps.size());
}

template <class T>
void convert(const std::vector<char>& bytes, double slope, double offset, float* values,
             std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
    values[i] = static_cast<float>(slope * static_cast<double>(value) + offset);
  }
}

/// The pixels of a file as rescaled numbers.
void read_pixels(const std::string& name, const gdcm::Image& image, float* values,
                 std::size_t count) {
  const gdcm::PixelFormat& format = image.GetPixelFormat();
  std::vector<char> bytes(image.GetBufferLength());
  if (format.GetSamplesPerPixel() != 1 ||
      bytes.size() != count * static_cast<std::size_t>(format.GetPixelSize()) ||
      !image.GetBuffer(bytes.data())) {
    throw InputError(fmt::format(
        "{}: its pixels cannot be read; export the series again with one grey value per pixel",
        name));
  }
  const auto take = [&]<class T>(T) {
    convert<T>(bytes, image.GetSlope(), image.GetIntercept(), values, count);
  };
  switch (format.GetScalarType()) {
    case gdcm::PixelFormat::UINT8:
      return take(std::uint8_t{});
    case gdcm::PixelFormat::INT8:
      return take(std::int8_t{});
    case gdcm::PixelFormat::UINT16:
      return take(std::uint16_t{});
    case gdcm::PixelFormat::INT16:
      return take(std::int16_t{});
    case gdcm::PixelFormat::UINT32:
      return take(std::uint32_t{});
    case gdcm::PixelFormat::INT32:
      return take(std::int32_t{});
    default:
      throw InputError(fmt::format("{}: its pixels are {}; allowed: 8- to 32-bit integers", name,
                                   format.GetScalarTypeAsString()));
  }
}

void open(gdcm::ImageReader& reader, const fs::path& file) {
  reader.SetFileName(file.c_str());
  if (!reader.Read()) {
    throw InputError(
        fmt::format("{}: cannot be read as a DICOM file; copy or export it again", file.string()));
  }
}

SourceVolume read_series(const std::string& name, std::vector<Slice> slices, const Room& room) {
  check_alike(name, slices);
  const Eigen::Vector3d step = order(name, slices);
  const Slice& first = slices.front();
  SourceVolume volume;
  VolumeHead& head = volume.head;
  head.format = fmt::format("DICOM, {} slices", slices.size());
  head.hounsfield = first.modality == "CT";
  head.size = {first.columns, first.rows, static_cast<std::int32_t>(slices.size())};
  head.steps.col(0) = 1e-3 * first.spacing[1] * first.along_row;
  head.steps.col(1) = 1e-3 * first.spacing[0] * first.along_column;
  head.steps.col(2) = 1e-3 * step;
  head.origin = 1e-3 * first.place;
  check_head(name, head, room);
  volume.values.resize(head.count());
  const std::size_t count = head.count() / slices.size();
  for (std::size_t i = 0; i < slices.size(); ++i) {
    gdcm::ImageReader reader;
    open(reader, slices[i].file);
    read_pixels(slices[i].file.string(), reader.GetImage(), volume.values.data() + i * count,
                count);
  }
  return volume;
}

/// One file with many frames (enhanced CT).
SourceVolume read_frames(const Slice& slice, const Room& room) {
  const std::string name = slice.file.string();
  gdcm::ImageReader reader;
  open(reader, slice.file);
  const gdcm::Image& image = reader.GetImage();
  if (image.GetNumberOfDimensions() != 3) {
    throw InputError(fmt::format(
        "{}: has one frame; choose a folder with a series or a file with several frames", name));
  }
  SourceVolume volume;
  VolumeHead& head = volume.head;
  head.format = fmt::format("DICOM, {} frames", slice.frames);
  head.hounsfield = slice.modality == "CT";
  const double* cosines = image.GetDirectionCosines();
  const Eigen::Vector3d x(cosines[0], cosines[1], cosines[2]);
  const Eigen::Vector3d y(cosines[3], cosines[4], cosines[5]);
  const Eigen::Vector3d axes[] = {x, y, x.cross(y)};
  for (unsigned i = 0; i < 3; ++i) {
    head.size[i] = static_cast<std::int32_t>(std::min(image.GetDimensions()[i], 1U << 30));
    head.steps.col(i) = 1e-3 * image.GetSpacing(i) * axes[i];
    head.origin[i] = 1e-3 * image.GetOrigin(i);
  }
  check_head(name, head, room);
  volume.values.resize(head.count());
  read_pixels(name, image, volume.values.data(), head.count());
  return volume;
}

}  // namespace

SourceVolume read_dicom(const fs::path& path, const Room& room) {
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  if (fs::is_directory(path)) {
    std::vector<Slice> slices = slices_in(path);
    if (slices.size() == 1 && slices[0].frames > 1) {
      return read_frames(slices[0], room);
    }
    return read_series(path.string(), std::move(slices), room);
  }
  const auto slice = read_slice(path);
  if (!slice) {
    throw InputError(fmt::format("{}: is not an image in DICOM format", path.string()));
  }
  return read_frames(*slice, room);
}

}  // namespace haptrial::bone
