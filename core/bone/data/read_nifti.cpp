#include <fmt/format.h>
#include <nifti/nifti2_io.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "core/base/error.h"
#include "core/bone/data/read_volume_internal.h"

namespace haptrial::bone {
namespace {

struct ForgetNifti {
  void operator()(nifti_image* image) const { nifti_image_free(image); }
};

/// @throws InputError for a unit that does not measure length.
double nifti_metres(const std::string& name, int unit) {
  switch (unit) {
    case NIFTI_UNITS_METER:
      return 1.0;
    case NIFTI_UNITS_MICRON:
      return 1e-6;
    case NIFTI_UNITS_MM:
    case NIFTI_UNITS_UNKNOWN:  // millimetres by the custom of all programs
      return 1e-3;
    default:
      throw InputError(fmt::format(
          "{}: its unit of length is code {}; allowed: 0 to 3 (none, m, mm, um)", name, unit));
  }
}

/// The columns of a matrix of the file, which is RAS.
void take_nifti_places(const nifti_dmat44& matrix, double unit, VolumeHead& head) {
  const Eigen::Vector3d to_lps(-unit, -unit, unit);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      head.steps(row, column) = to_lps[row] * matrix.m[row][column];
    }
    head.origin[row] = to_lps[row] * matrix.m[row][3];
  }
}

VolumeHead nifti_head(const std::string& name, const nifti_image& image) {
  VolumeHead head;
  head.format = fmt::format("NIfTI{}", image.xyz_units == NIFTI_UNITS_UNKNOWN ? kNoUnit : "");
  const std::int64_t more[] = {image.nt, image.nu, image.nv, image.nw};
  if (image.ndim < 3 || std::ranges::any_of(more, [](auto size) { return size > 1; })) {
    throw InputError(
        fmt::format("{}: has {} axes; allowed: 3, with one value per voxel, so one volume of a "
                    "series",
                    name, image.ndim));
  }
  const std::int64_t sizes[] = {image.nx, image.ny, image.nz};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    head.size[axis] = static_cast<std::int32_t>(std::clamp<std::int64_t>(sizes[axis], 0, 1 << 30));
  }
  const double unit = nifti_metres(name, image.xyz_units);
  if (image.sform_code > 0) {
    take_nifti_places(image.sto_xyz, unit, head);
  } else if (image.qform_code > 0) {
    take_nifti_places(image.qto_xyz, unit, head);
  } else {
    head.notes.push_back(assumed_orientation(name, "right-anterior-superior"));
    head.steps = (unit * Eigen::Vector3d(-image.dx, -image.dy, image.dz)).asDiagonal();
  }
  head.labels = image.intent_code == NIFTI_INTENT_LABEL;
  return head;
}

/// Loads the values as they are in the file. The library makes real numbers that are not finite 0,
/// which is water in a scan; integers of the same size it leaves alone.
bool load_nifti(nifti_image& image) {
  const int type = image.datatype;
  image.datatype = type == DT_FLOAT32 ? DT_INT32 : type == DT_FLOAT64 ? DT_INT64 : type;
  const bool loaded = nifti_image_load(&image) == 0 && image.data != nullptr;
  image.datatype = type;
  return loaded;
}

template <class T>
void convert_nifti(const void* data, double slope, double offset, BigArray<float>& values) {
  const auto* bytes = static_cast<const char*>(data);
  for (std::size_t i = 0; i < values.size(); ++i) {
    T value;
    std::memcpy(&value, bytes + i * sizeof(T), sizeof(T));
    values[i] = static_cast<float>(slope * static_cast<double>(value) + offset);
  }
}

/// @returns false for a type that is no number.
bool convert_nifti(const nifti_image& image, BigArray<float>& values) {
  const bool scaled = std::isfinite(image.scl_slope) && image.scl_slope != 0.0;
  const double slope = scaled ? image.scl_slope : 1.0;
  const double offset = scaled && std::isfinite(image.scl_inter) ? image.scl_inter : 0.0;
  const auto take = [&]<class T>(T) { convert_nifti<T>(image.data, slope, offset, values); };
  switch (image.datatype) {
    case DT_UINT8:
      return take(std::uint8_t{}), true;
    case DT_INT8:
      return take(std::int8_t{}), true;
    case DT_UINT16:
      return take(std::uint16_t{}), true;
    case DT_INT16:
      return take(std::int16_t{}), true;
    case DT_UINT32:
      return take(std::uint32_t{}), true;
    case DT_INT32:
      return take(std::int32_t{}), true;
    case DT_UINT64:
      return take(std::uint64_t{}), true;
    case DT_INT64:
      return take(std::int64_t{}), true;
    case DT_FLOAT32:
      return take(float{}), true;
    case DT_FLOAT64:
      return take(double{}), true;
    default:
      return false;
  }
}

}  // namespace

SourceVolume read_nifti(const std::filesystem::path& file, const Room& room) {
  const std::string name = file.string();
  nifti_set_debug_level(0);
  const std::unique_ptr<nifti_image, ForgetNifti> image(nifti_image_read(name.c_str(), 0));
  if (!image) {
    throw InputError(fmt::format("{}: cannot be read as NIfTI: its header is damaged", name));
  }
  SourceVolume volume{nifti_head(name, *image), {}};
  check_head(name, volume.head, room);
  if (static_cast<std::size_t>(image->nvox) != volume.head.count() || !load_nifti(*image)) {
    throw InputError(fmt::format("{}: is shorter than its header states, or damaged", name));
  }
  volume.values.resize(volume.head.count());
  if (!convert_nifti(*image, volume.values)) {
    throw InputError(fmt::format("{}: its values are of type {}; allowed: integers or real numbers",
                                 name, nifti_datatype_string(image->datatype)));
  }
  return volume;
}

}  // namespace haptrial::bone
