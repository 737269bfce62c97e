#include <fmt/format.h>
#include <gdcm-3.0/gdcmAttribute.h>
#include <gdcm-3.0/gdcmImageReader.h>
#include <gdcm-3.0/gdcmReader.h>
#include <gdcm-3.0/gdcmSequenceOfItems.h>
#include <gdcm-3.0/gdcmTrace.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/bone/data/read_volume_internal.h"

namespace haptrial::bone {
namespace fs = std::filesystem;
namespace {

struct Rescale {
  double slope{1.0};
  double offset{0.0};
};

/// One frame as its file states it, in millimetres.
struct Slice {
  fs::path file;
  int frame{0};
  int frames{1};  // of the file
  std::string series;
  std::string modality;
  int rows{0};
  int columns{0};
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};
  Eigen::Vector3d along_row{Eigen::Vector3d::Zero()};     // where columns count up
  Eigen::Vector3d along_column{Eigen::Vector3d::Zero()};  // where rows count up
  Eigen::Vector2d spacing{Eigen::Vector2d::Zero()};       // between rows, between columns
  bool placed{false};
  bool whole{true};                // as far as its size says
  std::optional<Rescale> rescale;  // of a functional group; else gdcm's for the file

  std::string name() const {
    const std::string words = file.filename().string();
    return frames > 1 ? fmt::format("frame {} of {}", frame + 1, words) : words;
  }
};

/// The functional groups of an enhanced file.
class FrameGroups {
 public:
  explicit FrameGroups(const gdcm::DataSet& data)
      : all_(data),
        shared_(sequence(data, {0x5200, 0x9229})),
        each_(sequence(data, {0x5200, 0x9230})) {}

  bool found() const { return shared_ || each_; }
  /// The attributes of a group for a frame from 0: its own, those of all frames, or the file's.
  gdcm::DataSet group(int frame, const gdcm::Tag& tag) const {
    for (const auto& [items, number] : {std::pair(each_, frame + 1), std::pair(shared_, 1)}) {
      if (!items || static_cast<std::size_t>(number) > items->GetNumberOfItems()) {
        continue;
      }
      const auto inner =
          sequence(items->GetItem(static_cast<std::size_t>(number)).GetNestedDataSet(), tag);
      if (inner && inner->GetNumberOfItems() > 0) {
        return inner->GetItem(1).GetNestedDataSet();
      }
    }
    return all_;
  }

 private:
  using Items = gdcm::SmartPointer<gdcm::SequenceOfItems>;
  static Items sequence(const gdcm::DataSet& data, const gdcm::Tag& tag) {
    return data.FindDataElement(tag) ? data.GetDataElement(tag).GetValueAsSQ() : Items();
  }

  const gdcm::DataSet& all_;
  Items shared_;
  Items each_;
};

/// Whether the pixels have room behind their tag; unknown where they are compressed.
bool is_whole(const gdcm::Reader& reader, const Slice& slice, int bits) {
  const gdcm::DataSet& data = reader.GetFile().GetDataSet();
  for (const gdcm::Tag& tag : {gdcm::Tag(0x7fe0, 0x0008), gdcm::Tag(0x7fe0, 0x0009)}) {
    if (data.FindDataElement(tag)) {
      throw InputError(fmt::format(
          "{}: its pixels are real numbers; allowed: 8- to 32-bit integers", slice.file.string()));
    }
  }
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

template <class Attribute>
std::optional<Attribute> find_in_group(const FrameGroups& groups, int frame, const gdcm::Tag& tag) {
  return find<Attribute>(groups.group(frame, tag));
}

/// Position and orientation of a frame, and what turns its pixels into numbers.
void place_frame(const gdcm::DataSet& data, const FrameGroups& groups, Slice& slice) {
  const gdcm::Tag position_group(0x0020, 0x9113);
  const gdcm::Tag orientation_group(0x0020, 0x9116);
  const gdcm::Tag measures_group(0x0028, 0x9110);
  const gdcm::Tag rescale_group(0x0028, 0x9145);
  const int frame = slice.frame;
  const auto place = find_in_group<gdcm::Attribute<0x0020, 0x0032>>(groups, frame, position_group);
  const auto turned =
      find_in_group<gdcm::Attribute<0x0020, 0x0037>>(groups, frame, orientation_group);
  const auto spacing =
      find_in_group<gdcm::Attribute<0x0028, 0x0030>>(groups, frame, measures_group);
  // Without functional groups a file gives the place of its first frame, and perhaps a distance.
  const bool alone = slice.frames > 1 && !groups.found();
  const auto gap = find<gdcm::Attribute<0x0018, 0x0088>>(data);
  slice.placed = place && turned && spacing && (!alone || (gap && gap->GetValue() > 0.0));
  if (!slice.placed) {
    return;
  }
  for (unsigned i = 0; i < 3; ++i) {
    slice.place[i] = place->GetValue(i);
    slice.along_row[i] = turned->GetValue(i);
    slice.along_column[i] = turned->GetValue(i + 3);
  }
  slice.spacing = {spacing->GetValue(0), spacing->GetValue(1)};
  if (alone) {  // "along the normal to the first image", says the standard
    slice.place += frame * gap->GetValue() * slice.along_row.cross(slice.along_column);
  }
  const auto slope = find_in_group<gdcm::Attribute<0x0028, 0x1053>>(groups, frame, rescale_group);
  const auto offset = find_in_group<gdcm::Attribute<0x0028, 0x1052>>(groups, frame, rescale_group);
  if (groups.found() && slope && offset) {
    slice.rescale = {slope->GetValue(), offset->GetValue()};
  }
}

/// One for each frame; none where the file is not an image in DICOM format.
std::vector<Slice> read_slices(const fs::path& file) {
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  if (!reader.CanRead() || !reader.ReadUpToTag(gdcm::Tag(0x7fe0, 0x0010))) {
    return {};
  }
  const gdcm::DataSet& data = reader.GetFile().GetDataSet();
  Slice slice;
  slice.file = file;
  const auto rows = find<gdcm::Attribute<0x0028, 0x0010>>(data);
  const auto columns = find<gdcm::Attribute<0x0028, 0x0011>>(data);
  if (!rows || !columns) {
    return {};
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
    constexpr int kMost = 32767;
    slice.frames = frames->GetValue();
    if (slice.frames < 1 || slice.frames > kMost) {
      throw InputError(
          fmt::format("{}: has {} frames; allowed: 1 to {}", file.string(), slice.frames, kMost));
    }
  }
  const auto bits = find<gdcm::Attribute<0x0028, 0x0100>>(data);
  slice.whole = !bits || is_whole(reader, slice, bits->GetValue());
  const FrameGroups groups(data);
  std::vector<Slice> slices(static_cast<std::size_t>(slice.frames), slice);
  for (std::size_t i = 0; i < slices.size(); ++i) {
    slices[i].frame = static_cast<int>(i);
    place_frame(data, groups, slices[i]);
  }
  return slices;
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
    std::ranges::move(read_slices(file), std::back_inserter(slices));
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
    const std::string file = slice.name();
    if (!slice.whole) {
      throw InputError(fmt::format("{}: {} is incomplete; copy it again", name, file));
    }
    if (!slice.placed) {
      throw InputError(
          fmt::format("{}: {} does not give the place of its slice; every slice and every frame "
                      "needs position, orientation and pixel spacing",
                      name, file));
    }
    if (slice.rows != first.rows || slice.columns != first.columns ||
        !((slice.spacing - first.spacing).norm() < kSame * first.spacing.norm()) ||
        !((slice.along_row - first.along_row).norm() < kSame) ||
        !((slice.along_column - first.along_column).norm() < kSame)) {
      throw InputError(
          fmt::format("{}: {} has another size or orientation than {}; keep only slices of one "
                      "series in the folder",
                      name, file, first.name()));
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
                      name, slices[i].name(), slices[i + 1].name(), gaps[i], usual));
    }
  }
  const Eigen::Vector3d first = slices.front().place;
  const Eigen::Vector3d step = (slices.back().place - first) / static_cast<double>(gaps.size());
  for (std::size_t i = 0; i < slices.size(); ++i) {
    constexpr double kOff = 0.25;  // of a gap
    const double off = (slices[i].place - first - static_cast<double>(i) * step).norm();
    if (!(off <= kOff * usual)) {
      throw InputError(fmt::format(
          "{}: {} lies {:.3g} mm beside the line through the first and the last slice; allowed: "
          "slices at equal distances on a line",
          name, slices[i].name(), off));
    }
  }
  return step;
}

/// Stored numbers that stand for no value (PixelPaddingValue).
struct Padding {
  std::int64_t low{1};
  std::int64_t high{0};
};

Padding padding_of(const gdcm::DataSet& data, const gdcm::PixelFormat& format) {
  const auto number = [&](const gdcm::Tag& tag) -> std::optional<std::int64_t> {
    const gdcm::ByteValue* bytes =
        data.FindDataElement(tag) ? data.GetDataElement(tag).GetByteValue() : nullptr;
    std::uint16_t value = 0;
    if (bytes == nullptr || !bytes->GetBuffer(reinterpret_cast<char*>(&value), sizeof value)) {
      return std::nullopt;
    }
    return format.GetPixelRepresentation() == 1 ? static_cast<std::int16_t>(value) : value;
  };
  const auto value = number({0x0028, 0x0120});
  if (!value) {
    return {};
  }
  const std::int64_t limit = number({0x0028, 0x0121}).value_or(*value);
  return {std::min(*value, limit), std::max(*value, limit)};
}

/// Padding, and in a CT whatever is below air, becomes NaN: see read_volume().
template <class T>
void convert(const char* bytes, const Rescale& rescale, const Padding& padding, float lowest,
             std::span<float> values) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < values.size(); ++i) {
    T stored;
    std::memcpy(&stored, bytes + i * sizeof(T), sizeof(T));
    const auto value =
        static_cast<float>(rescale.slope * static_cast<double>(stored) + rescale.offset);
    const bool padded = stored >= padding.low && stored <= padding.high;
    values[i] = padded || value < lowest ? kNone : value;
  }
}

/// The pixels of a file, opened once for all of its frames.
class Pixels {
 public:
  explicit Pixels(const fs::path& file) : name_(file.string()) {
    gdcm::ImageReader reader;
    open(reader, file);
    const gdcm::Image& image = reader.GetImage();
    format_ = image.GetPixelFormat();
    rescale_ = {image.GetSlope(), image.GetIntercept()};
    padding_ = padding_of(reader.GetFile().GetDataSet(), format_);
    bytes_.resize(image.GetBufferLength());
    if (format_.GetSamplesPerPixel() != 1 || !image.GetBuffer(bytes_.data())) {
      fail();
    }
  }

  /// The rescaled numbers of a slice.
  void read(const Slice& slice, std::span<float> values) const {
    const std::size_t size = values.size() * static_cast<std::size_t>(format_.GetPixelSize());
    const std::size_t start = size * static_cast<std::size_t>(slice.frame);
    if (start + size > bytes_.size()) {
      fail();
    }
    constexpr float kAir = -1024.0F;  // the least Hounsfield unit of 12 bits
    const float lowest = slice.modality == "CT" ? kAir : -std::numeric_limits<float>::infinity();
    const auto take = [&]<class T>(T) {
      convert<T>(bytes_.data() + start, slice.rescale.value_or(rescale_), padding_, lowest, values);
    };
    switch (format_.GetScalarType()) {
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
        throw InputError(fmt::format("{}: its pixels are {}; allowed: 8- to 32-bit integers", name_,
                                     format_.GetScalarTypeAsString()));
    }
  }

 private:
  static void open(gdcm::ImageReader& reader, const fs::path& file) {
    reader.SetFileName(file.c_str());
    if (!reader.Read()) {
      throw InputError(fmt::format("{}: cannot be read as a DICOM file; copy or export it again",
                                   file.string()));
    }
  }
  [[noreturn]] void fail() const {
    throw InputError(fmt::format(
        "{}: its pixels cannot be read; export the series again with one grey value per pixel",
        name_));
  }

  std::string name_;
  gdcm::PixelFormat format_;
  Rescale rescale_;
  Padding padding_;
  std::vector<char> bytes_;
};

/// Files one after the other, whatever the order of their slices.
void read_values(const std::vector<Slice>& slices, std::size_t count, std::span<float> values) {
  std::vector<std::size_t> order(slices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return slices[i].file; });
  std::optional<Pixels> pixels;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const Slice& slice = slices[order[n]];
    if (n == 0 || slice.file != slices[order[n - 1]].file) {
      pixels.emplace(slice.file);
    }
    pixels->read(slice, values.subspan(order[n] * count, count));
  }
}

SourceVolume read_series(const std::string& name, std::vector<Slice> slices, const Room& room) {
  check_alike(name, slices);
  const Eigen::Vector3d step = order(name, slices);
  const Slice& first = slices.front();
  SourceVolume volume;
  VolumeHead& head = volume.head;
  head.format = fmt::format("DICOM, {} {}", slices.size(), first.frames > 1 ? "frames" : "slices");
  head.hounsfield = first.modality == "CT";
  head.size = {first.columns, first.rows, static_cast<std::int32_t>(slices.size())};
  head.steps.col(0) = 1e-3 * first.spacing[1] * first.along_row;
  head.steps.col(1) = 1e-3 * first.spacing[0] * first.along_column;
  head.steps.col(2) = 1e-3 * step;
  head.origin = 1e-3 * first.place;
  check_head(name, head, room);
  volume.values.resize(head.count());
  read_values(slices, head.count() / slices.size(), {volume.values.data(), volume.values.size()});
  const auto none = std::ranges::count_if(volume.values, [](float v) { return std::isnan(v); });
  if (none > 0) {
    head.format +=
        fmt::format(", {} pixels of padding or below air taken as the lowest value", none);
  }
  return volume;
}

}  // namespace

SourceVolume read_dicom(const fs::path& path, const Room& room) {
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  std::vector<Slice> slices = fs::is_directory(path) ? slices_in(path) : read_slices(path);
  if (slices.empty()) {
    throw InputError(fmt::format("{}: is not an image in DICOM format", path.string()));
  }
  return read_series(path.string(), std::move(slices), room);
}

}  // namespace haptrial::bone
