// Scans as other programs write them: one body in every dialect of the three formats, by recipe.

#include <gdcm-3.0/gdcmAttribute.h>
#include <gdcm-3.0/gdcmReader.h>
#include <gdcm-3.0/gdcmWriter.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/bone/data/load_bone.h"
#include "tests/core/bone/data/volume_bytes.h"
#include "tests/support/dicom_series.h"
#include "tests/support/message_of.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::bone::public_volumes_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::PlainVolume;
using ::testing::HasSubstr;

/// Two boxes of bone [mm] that no turn and no mirror brings onto themselves.
bool is_bone(const Vector3d& p) {
  const auto within = [&](const Vector3d& low, const Vector3d& high) {
    return (p.array() > low.array()).all() && (p.array() < high.array()).all();
  };
  return within({-7, -4, -3}, {1, 6, 5}) || within({3, -6, 2}, {8, -1, 7});
}
constexpr double kBodyVolume = 8.0 * 10.0 * 8.0 + 5.0 * 5.0 * 5.0;  // [mm³]
constexpr int kBone = 1200, kAir = -1000;                           // [HU]

int value_of(const Vector3d& p) { return is_bone(p) ? kBone : kAir; }

/// The body in voxels of half a millimetre, along axes that may be any three.
PlainVolume body(const Matrix3d& axes = Matrix3d::Identity(),
                 std::array<int, 3> size = {44, 44, 44}) {
  PlainVolume volume(size);
  volume.steps = 0.5 * axes;
  volume.origin = Vector3d(0.5, 0.0, 2.0) -
                  volume.steps * Vector3d(size[0] - 1, size[1] - 1, size[2] - 1) / 2.0;
  return volume.fill(value_of);
}

/// Whether all of a bone lies where the body does, but for a millimetre at its faces.
void expect_body(const BoneModel& model, const Vector3d& moved = Vector3d::Zero()) {
  constexpr double kEdge = 1.0;
  std::size_t wrong = 0, held = 0;
  const geometry::VoxelGrid& grid = model.grid;
  geometry::visit_voxels(grid, [&](const Eigen::Vector3i& voxel, std::size_t at) {
    const Vector3d p = 1e3 * grid.centre(voxel) - moved;
    const bool bone = model.labels[at] != 0;
    bool near = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-kEdge, kEdge}) {
        near = near || is_bone(p + side * Vector3d::Unit(axis)) != is_bone(p);
      }
    }
    held += bone ? 1 : 0;
    wrong += !near && bone != is_bone(p) ? 1 : 0;
  });
  EXPECT_EQ(wrong, 0u);
  EXPECT_NEAR(static_cast<double>(held) * std::pow(1e3 * grid.spacing, 3), kBodyVolume,
              0.06 * kBodyVolume);
}

Matrix3d turned(double degrees) {
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Vector3d(1, 2, -1).normalized())
      .toRotationMatrix();
}

/// Columns x, y, z in another order or direction.
Matrix3d columns(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  Matrix3d axes;
  axes << a, b, c;
  return axes;
}

/// Slices that a gantry tilts, one above the other.
Matrix3d tilted(double degrees) {
  const double tilt = degrees * std::numbers::pi / 180.0;
  return columns(Vector3d::UnitX(), {0, std::cos(tilt), -std::sin(tilt)}, Vector3d::UnitZ());
}

/// The head of an NRRD file with other values behind it.
template <class T>
std::string nrrd_with(const std::string& type, bool big = false) {
  const PlainVolume volume = body();
  std::string bytes = test::replaced(nrrd_of(volume), "int16", type);
  bytes.resize(bytes.size() - sizeof(std::int16_t) * volume.values.size());
  for (const std::int16_t stored : volume.values) {
    const auto value = static_cast<T>(stored);
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof value);
    if (big) {
      std::ranges::reverse(raw);
    }
    bytes.append(raw.data(), raw.size());
  }
  return big ? test::replaced(bytes, "endian: little", "endian: big") : bytes;
}

std::string nrrd_as_text() {
  const PlainVolume volume = body();
  std::string bytes = test::replaced(nrrd_of(volume), "encoding: raw", "encoding: ascii");
  bytes.resize(bytes.size() - sizeof(std::int16_t) * volume.values.size());
  for (const std::int16_t value : volume.values) {
    bytes += fmt::format("{}\n", value);
  }
  return bytes;
}

std::string nrrd_in(const std::string& unit, double millimetres) {
  PlainVolume volume = body();
  volume.steps /= millimetres;
  volume.origin /= millimetres;
  volume.more = fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\n", unit);
  return nrrd_of(volume);
}

/// A NRRD file without space: the first voxel lies at the origin.
std::string nrrd_of_spacings() {
  const PlainVolume volume = body();
  const std::string bytes = nrrd_of(volume);
  return "NRRD0001\ntype: short\ndimension: 3\nsizes: 44 44 44\nspacings: 0.5 0.5 0.5\n"
         "endian: little\nencoding: raw\n" +
         bytes.substr(bytes.find("\n\n") + 1);
}

template <class T>
std::string nifti_with(std::string bytes, std::size_t at, T value) {
  return bytes.replace(at, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
}

/// Turned by its quaternion: half a turn about z, since NIfTI counts to the right and the front.
std::string nifti_of_quaternion() {
  const PlainVolume volume = body();
  std::string bytes = nifti_with(nifti_of(volume, false), 252, std::int16_t{1});
  bytes = nifti_with(bytes, 264, 1.0F);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double sign = axis < 2 ? -1.0 : 1.0;
    bytes = nifti_with(bytes, 268 + 4 * axis,
                       static_cast<float>(sign * volume.origin[static_cast<long>(axis)]));
  }
  return bytes;
}

std::string nifti_scaled() {
  PlainVolume volume = body();
  for (std::int16_t& value : volume.values) {
    value = static_cast<std::int16_t>((value + 24) / 2);
  }
  return nifti_with(nifti_with(nifti_of(volume), 112, 2.0F), 116, -24.0F);
}

std::string nifti_with_extension() {
  std::string bytes = nifti_with(nifti_of(body()), 108, 368.0F);
  bytes[348] = 1;
  return bytes.insert(352, std::string("\x10\0\0\0\x06\0\0\0comment\0", 16));
}

std::string nifti_in_metres() {
  PlainVolume volume = body();
  volume.steps *= 1e-3;
  volume.origin *= 1e-3;
  return nifti_with(nifti_of(volume), 123, char{1});
}

struct File {
  std::string what;
  std::string name;
  std::string bytes;
  std::string refusal{};             // part of the sentence
  Vector3d moved{Vector3d::Zero()};  // [mm]
};

std::vector<File> nrrd_files() {
  const PlainVolume plain = body();
  const std::string bytes = nrrd_of(plain);
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  PlainVolume anterior = body();
  anterior.steps.row(1) *= -1.0;
  anterior.origin.y() *= -1.0;
  const std::string list = test::replaced(
      test::replaced(test::replaced(test::replaced(bytes, "dimension: 3", "dimension: 4"),
                                    "sizes: ", "sizes: 1 "),
                     "space directions: ", "space directions: none "),
      "kinds: ", "kinds: list ");
  const std::string series = test::replaced(
      test::replaced(test::replaced(test::replaced(bytes, "dimension: 3", "dimension: 4"),
                                    "sizes: 44 44 44", "sizes: 2 22 44 44"),
                     "\nkinds", " none\nkinds"),
      "kinds: domain domain domain", "kinds: domain domain domain time");
  return {
      {"along the patient's axes", "v.nrrd", bytes},
      {"right, anterior, superior, compressed", "v.nrrd", nrrd_of(plain, true, true)},
      {"left, anterior, superior", "v.nrrd",
       test::replaced(nrrd_of(anterior), "left-posterior-superior", "left-anterior-superior")},
      {"axes in another order", "v.nrrd", nrrd_of(body(columns(z, x, y)))},
      {"axes the other way", "v.nrrd", nrrd_of(body(columns(-x, y, -z)))},
      {"left-handed", "v.nrrd", nrrd_of(body(columns(x, -y, z)))},
      {"turned", "v.nrrd", nrrd_of(body(turned(20.0)))},
      {"turned a little", "v.nrrd", nrrd_of(body(turned(1.5)))},
      {"not at right angles", "v.nrrd", nrrd_of(body(tilted(12.0), {44, 44, 56}))},
      {"greatest byte first", "v.nrrd", nrrd_with<std::int16_t>("int16", true)},
      {"real numbers", "v.nrrd", nrrd_with<float>("float")},
      {"double numbers", "v.nrrd", nrrd_with<double>("double")},
      {"as text", "v.nrrd", nrrd_as_text()},
      {"in micrometres", "v.nrrd", nrrd_in("um", 1e-3)},
      {"in metres", "v.nrrd", nrrd_in("m", 1e3)},
      {"spacings alone", "v.nrrd", nrrd_of_spacings(), "", -plain.origin},
      {"one value in a list", "v.nrrd", list},
      {"capitals", "V.NRRD", bytes},
      {"a unit that is not known", "v.nrrd", nrrd_in("ell", 1.0), "unit of length is 'ell'"},
      {"a series in time", "v.nrrd", series, "has 4 axes of 2 x 22 x 44 x 44"},
      {"cut off", "v.nrrd", bytes.substr(0, 9000), "damaged or incomplete"},
  };
}

std::vector<File> nifti_files() {
  const std::string bytes = nifti_of(body());
  return {
      {"by its matrix", "v.nii", bytes},
      {"by its matrix, turned", "v.nii", nifti_of(body(turned(20.0)))},
      {"by its quaternion", "v.nii", nifti_of_quaternion()},
      {"compressed", "v.nii.gz", test::gzip(bytes)},
      {"capitals", "V.NII", bytes},
      {"capitals, compressed", "V.NII.GZ", test::gzip(bytes)},
      {"slope and offset", "v.nii", nifti_scaled()},
      {"an extension of the head", "v.nii", nifti_with_extension()},
      {"in metres", "v.nii", nifti_in_metres()},
      {"a series in time", "v.nii",
       nifti_with(nifti_with(bytes, 40, std::int16_t{4}), 48, std::int16_t{2}), "has 4 axes"},
      {"cut off", "v.nii", bytes.substr(0, 9000), "shorter than its header states"},
  };
}

class PublicVolumesTest : public ::testing::Test {
 protected:
  void check(const std::vector<File>& files) {
    for (const File& file : files) {
      SCOPED_TRACE(file.name + ": " + file.what);
      const auto path = folder_ / file.name;
      test::write_bytes(path, file.bytes);
      if (file.refusal.empty()) {
        expect_body(load_bone(path), file.moved);
      } else {
        EXPECT_THAT(test::message_of([&] { load_bone(path); }), HasSubstr(file.refusal));
      }
    }
  }
  /// A series whose files have the names `name(slice)`.
  template <class Name>
  std::filesystem::path series(const std::string& folder, const Matrix3d& axes, const Name& name) {
    constexpr int kPixels = 44, kSlices = 44;
    const Vector3d step(0.5, 0.5, 0.5);
    const Vector3d far = (step.array() * Vector3d(kPixels - 1, kPixels - 1, kSlices - 1).array());
    test::DicomSeries scan{{kPixels, kPixels, kSlices}, step, {}, axes, "1.2.3", {}};
    scan.origin = Vector3d(0.5, 0.0, 2.0) - axes * far / 2.0;
    scan.value = [&](int i, int j, int k) {
      return value_of(scan.origin + axes * step.cwiseProduct(Vector3d(i, j, k)));
    };
    std::filesystem::create_directories(folder_ / folder);
    for (int k = 0; k < kSlices; ++k) {
      test::write_dicom_slice(folder_ / folder / name(k), scan, k);
    }
    return folder_ / folder;
  }
  test::TemporaryFolder folder_;
};

std::string in_order(int slice) { return fmt::format("IM{:04}", slice); }

TEST_F(PublicVolumesTest, NrrdIsTheSameBodyOrRefused) { check(nrrd_files()); }

TEST_F(PublicVolumesTest, NiftiIsTheSameBodyOrRefused) { check(nifti_files()); }

TEST_F(PublicVolumesTest, ADetachedHeadFindsItsValues) {
  const std::string bytes = nrrd_of(body());
  const std::size_t end = bytes.find("\n\n") + 1;
  test::write_bytes(folder_ / "v.nhdr", bytes.substr(0, end) + "data file: v.raw\n");
  test::write_bytes(folder_ / "v.raw", bytes.substr(end + 1));
  expect_body(load_bone(folder_ / "v.nhdr"));
}

TEST_F(PublicVolumesTest, DicomSeriesAreTheSameBody) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const std::vector<std::pair<const char*, Matrix3d>> lies{{"axial", Matrix3d::Identity()},
                                                           {"sagittal", columns(y, -z, -x)},
                                                           {"coronal", columns(x, -z, y)},
                                                           {"oblique", turned(20.0)},
                                                           {"gantry", tilted(12.0)}};
  for (const auto& [name, axes] : lies) {
    SCOPED_TRACE(name);
    expect_body(load_bone(series(name, axes, in_order)));
  }
  expect_body(load_bone(series("names", Matrix3d::Identity(), [](int slice) {
    return fmt::format("{}.{}.DCM", 7 * slice % 44, slice);
  })));
}

/// A dose of one frame, with places of frames that it does not have.
TEST_F(PublicVolumesTest, OneFrameOfADoseIsOneSlice) {
  const auto file = series("dose", Matrix3d::Identity(), in_order) / in_order(0);
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  ASSERT_TRUE(reader.Read());
  gdcm::DataSet& set = reader.GetFile().GetDataSet();
  gdcm::Attribute<0x0008, 0x0016> kind;
  kind.SetValue("1.2.840.10008.5.1.4.1.1.481.2");
  set.Replace(kind.GetAsDataElement());
  gdcm::Attribute<0x0028, 0x0008> frames;
  frames.SetValue(1);
  set.Replace(frames.GetAsDataElement());
  gdcm::Attribute<0x0028, 0x0009> pointer;
  pointer.SetNumberOfValues(1);
  pointer.SetValue(0, gdcm::Tag(0x3004, 0x000c));
  set.Replace(pointer.GetAsDataElement());
  gdcm::Attribute<0x3004, 0x000c> offsets;
  offsets.SetNumberOfValues(15);
  for (unsigned i = 0; i < 15; ++i) {
    offsets.SetValue(i, 2.0 * i);
  }
  set.Replace(offsets.GetAsDataElement());
  gdcm::Writer writer;
  writer.SetFile(reader.GetFile());
  writer.SetFileName((folder_ / "dose.dcm").c_str());
  ASSERT_TRUE(writer.Write());
  EXPECT_THAT(test::message_of([&] { load_bone(folder_ / "dose.dcm"); }),
              HasSubstr("has 1 slice; allowed: 2 or more"));
}

}  // namespace
}  // namespace haptrial::bone::public_volumes_test
