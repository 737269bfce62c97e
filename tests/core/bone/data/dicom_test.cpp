// Series that gdcm writes, in any order and orientation, and what is wrong with some.

#include <gdcm-3.0/gdcmAttribute.h>
#include <gdcm-3.0/gdcmImageWriter.h>
#include <gdcm-3.0/gdcmUIDGenerator.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/bone/data/bone_summary.h"
#include "core/bone/data/load_bone.h"
#include "tests/core/bone/data/volume_bytes.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::bone {
namespace {

using ::testing::HasSubstr;

class DicomTest : public ::testing::Test {
 protected:
  static constexpr int kSize = 24;  // pixels and slices

  /// One slice of a bar of bone in air: stored numbers are Hounsfield units and 1024.
  void write(const std::string& name, int slice, const Eigen::Matrix3d& axes,
             const std::string& series, double shift = 0.0) {
    gdcm::ImageWriter writer;
    gdcm::Image& image = writer.GetImage();
    image.SetNumberOfDimensions(2);
    const unsigned dimensions[2] = {kSize, kSize};
    image.SetDimensions(dimensions);
    image.SetPixelFormat(gdcm::PixelFormat(gdcm::PixelFormat::UINT16));
    image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
    image.SetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
    image.SetSlope(1.0);
    image.SetIntercept(-1024.0);
    image.SetSpacing(0, 0.5);  // between columns
    image.SetSpacing(1, 1.0);  // between rows
    const Eigen::Vector3d place = axes * Eigen::Vector3d(0, 0, 2.0 * slice + shift);
    for (unsigned i = 0; i < 3; ++i) {
      image.SetOrigin(i, place[i]);
    }
    const Eigen::Matrix<double, 3, 2> cosines = axes.leftCols<2>();
    image.SetDirectionCosines(cosines.data());
    std::vector<std::uint16_t> pixels(kSize * kSize, 24);
    for (int j = 6; j < 18; ++j) {
      for (int i = 4; i < 20; ++i) {
        if (slice >= 5 && slice < 15) {
          pixels[static_cast<std::size_t>(i + kSize * j)] = 2224;
        }
      }
    }
    gdcm::DataElement data(gdcm::Tag(0x7fe0, 0x0010));
    data.SetByteValue(reinterpret_cast<const char*>(pixels.data()),
                      static_cast<unsigned>(pixels.size() * sizeof(std::uint16_t)));
    image.SetDataElement(data);
    gdcm::DataSet& set = writer.GetFile().GetDataSet();
    gdcm::Attribute<0x0008, 0x0060> modality;
    modality.SetValue("CT");
    set.Insert(modality.GetAsDataElement());
    gdcm::Attribute<0x0008, 0x0016> kind;
    kind.SetValue("1.2.840.10008.5.1.4.1.1.2");  // CT image
    set.Insert(kind.GetAsDataElement());
    gdcm::Attribute<0x0020, 0x000e> uid;
    uid.SetValue(series.c_str());
    set.Insert(uid.GetAsDataElement());
    writer.SetFileName((folder_ / name).c_str());
    ASSERT_TRUE(writer.Write());
  }
  /// All slices, in files whose names go the other way round.
  void write_series(const Eigen::Matrix3d& axes, const std::string& uid = "1.2.3") {
    for (int slice = 0; slice < kSize; ++slice) {
      write(fmt::format("{:02}.dcm", 90 - slice), slice, axes, uid);
    }
  }
  std::string refusal() {
    try {
      load_bone(folder_.path());
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }
  test::TemporaryFolder folder_;
};

TEST_F(DicomTest, ASeriesBecomesABoneInItsPlace) {
  write_series(Eigen::Matrix3d::Identity());
  test::write_bytes(folder_ / "readme.txt", "not a picture");
  const BoneModel model = load_bone(folder_.path());
  EXPECT_DOUBLE_EQ(model.grid.spacing, 0.5e-3);
  const BoneSummary summary = summary_of(model);
  // 16 columns of 0.5 mm, 12 rows of 1 mm, 10 slices of 2 mm; their middle.
  EXPECT_NEAR(1e9 * summary.volume, 8.0 * 12.0 * 20.0, 0.08 * 1920.0);
  const Eigen::Vector3d middle(0.5 * 11.5, 11.5, 2.0 * 9.5);
  EXPECT_LT((1e3 * summary.box.center() - middle).norm(), 0.3);
  EXPECT_THAT(model.source, HasSubstr("DICOM, 24 slices"));
  EXPECT_THAT(model.source, HasSubstr("from 300 HU"));
}

TEST_F(DicomTest, AnObliqueSeriesToo) {
  const Eigen::Matrix3d axes =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 0.3, -0.2).normalized()).toRotationMatrix();
  write_series(axes);
  const BoneModel model = load_bone(folder_.path());
  const BoneSummary summary = summary_of(model);
  EXPECT_NEAR(1e9 * summary.volume, 1920.0, 0.08 * 1920.0);
  const Eigen::Vector3d middle = axes * Eigen::Vector3d(0.5 * 11.5, 11.5, 2.0 * 9.5);
  EXPECT_LT((1e3 * summary.box.center() - middle).norm(), 0.7);
}

TEST_F(DicomTest, MissingRepeatedAndMixedSlicesAreNamed) {
  write_series(Eigen::Matrix3d::Identity());
  std::filesystem::remove(folder_ / "80.dcm");  // slice 10
  EXPECT_THAT(refusal(), HasSubstr("81.dcm and 79.dcm lie 4 mm apart, most slices 2 mm"));
  write("80.dcm", 10, Eigen::Matrix3d::Identity(), "1.2.3");
  EXPECT_EQ(refusal(), "none");
  write("extra.dcm", 10, Eigen::Matrix3d::Identity(), "1.2.3");
  EXPECT_THAT(refusal(), HasSubstr("lie 0 mm apart"));
  write("extra.dcm", 30, Eigen::Matrix3d::Identity(), "9.9.9");
  EXPECT_THAT(refusal(), HasSubstr("holds 2 series (1.2.3 and 9.9.9)"));
}

TEST_F(DicomTest, SpoiledFilesAreNamed) {
  EXPECT_THAT(refusal(), HasSubstr("none of its 0 files is an image in DICOM format"));
  write_series(Eigen::Matrix3d::Identity());
  const std::string whole = test::read_bytes(folder_ / "80.dcm");
  test::write_bytes(folder_ / "80.dcm", whole.substr(0, whole.size() - 100));
  EXPECT_THAT(refusal(), HasSubstr("80.dcm"));
  for (int slice = 1; slice < kSize; ++slice) {
    std::filesystem::remove(folder_ / fmt::format("{:02}.dcm", 90 - slice));
  }
  EXPECT_THAT(refusal(), HasSubstr("has 1 slice; allowed: 2 or more"));
}

TEST_F(DicomTest, ASpoiledSliceGivesABoneOrASentence) {
  write_series(Eigen::Matrix3d::Identity());
  const std::string whole = test::read_bytes(folder_ / "80.dcm");
  RandomStream random(3, "dicom");
  int refused = 0;
  constexpr int kTrials = 25;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::string bytes = whole;
    for (std::uint64_t change = random.below(6); change < 6; ++change) {
      const std::size_t at = random.below(std::min<std::size_t>(bytes.size(), 900));
      if (random.below(3) == 0) {
        bytes.erase(at, 1 + random.below(12));
      } else {
        bytes[at] = static_cast<char>(random.below(256));
      }
    }
    test::write_bytes(folder_ / "80.dcm", bytes);
    const std::string words = refusal();
    EXPECT_EQ(std::ranges::count(words, '\n'), 0) << words;
    refused += words != "none";
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace haptrial::bone
