// Series that gdcm writes, in any order and orientation, and what is wrong with some.

#include <gdcm-3.0/gdcmAttribute.h>
#include <gdcm-3.0/gdcmSequenceOfItems.h>
#include <gdcm-3.0/gdcmWriter.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/bone/data/bone_summary.h"
#include "core/bone/data/load_bone.h"
#include "tests/core/bone/data/volume_bytes.h"
#include "tests/support/dicom_series.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::bone {
namespace {

using ::testing::HasSubstr;

class DicomTest : public ::testing::Test {
 protected:
  static constexpr int kSize = 24;  // pixels and slices

  /// One slice of a bar of bone in air.
  void write(const std::string& name, int slice, const Eigen::Matrix3d& axes,
             const std::string& series, const Eigen::Vector3d& beside = Eigen::Vector3d::Zero()) {
    const auto bar = [](int i, int j, int k) {
      return i >= 4 && i < 20 && j >= 6 && j < 18 && k >= 5 && k < 15 ? 1200 : -1000;
    };
    test::write_dicom_slice(
        folder_ / name, {{kSize, kSize, kSize}, {0.5, 1.0, 2.0}, beside, axes, series, bar}, slice);
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

/// The bar of DicomTest as one file with many frames.
struct Frames {
  static constexpr int kPixels = 24;
  bool enhanced{true};
  std::vector<int> order{};          // slice of each frame
  double rescale_step{0.0};          // slope and offset change from frame to frame
  std::optional<double> distance{};  // SpacingBetweenSlices [mm]
  std::optional<int> padding{};      // stored number, in the two outermost columns

  static gdcm::Item item_with(const gdcm::Tag& group, const gdcm::DataSet& inner) {
    gdcm::Item within;
    within.SetVLToUndefined();
    within.SetNestedDataSet(inner);
    const gdcm::SmartPointer<gdcm::SequenceOfItems> sequence = new gdcm::SequenceOfItems;
    sequence->SetLengthToUndefined();
    sequence->AddItem(within);
    gdcm::DataElement element(group);
    element.SetVR(gdcm::VR::SQ);
    element.SetValue(*sequence);
    element.SetVLToUndefined();
    gdcm::Item outer;
    outer.SetVLToUndefined();
    outer.GetNestedDataSet().Insert(element);
    return outer;
  }
  template <class Attribute, class... Values>
  static void put(gdcm::DataSet& set, Values... values) {
    Attribute attribute;
    unsigned i = 0;
    (attribute.SetValue(values, i++), ...);
    set.Replace(attribute.GetAsDataElement());
  }
  template <class Attribute, class Value>
  static void put_one(gdcm::DataSet& set, Value value) {
    Attribute attribute;
    attribute.SetValue(static_cast<typename Attribute::ArrayType>(value));
    set.Replace(attribute.GetAsDataElement());
  }
  static void copy(const gdcm::Tag& group, const gdcm::DataSet& inner, gdcm::Item& to) {
    const gdcm::Item from = item_with(group, inner);
    to.GetNestedDataSet().Insert(from.GetNestedDataSet().GetDataElement(group));
  }

  double slope(int frame) const { return 1.0 + rescale_step * frame; }
  double offset(int frame) const { return -1024.0 - 100.0 * rescale_step * frame; }

  std::vector<std::uint16_t> pixels() const {
    std::vector<std::uint16_t> stored;
    for (std::size_t n = 0; n < order.size(); ++n) {
      const int frame = static_cast<int>(n);
      for (int j = 0; j < kPixels; ++j) {
        for (int i = 0; i < kPixels; ++i) {
          const bool bone = i >= 4 && i < 20 && j >= 6 && j < 18 && order[n] >= 5 && order[n] < 15;
          if (padding && (i < 2 || i >= kPixels - 2)) {
            stored.push_back(static_cast<std::uint16_t>(*padding));
            continue;
          }
          stored.push_back(static_cast<std::uint16_t>(
              std::lround(((bone ? 1200.0 : -1000.0) - offset(frame)) / slope(frame))));
        }
      }
    }
    return stored;
  }
  gdcm::DataElement groups() const {
    const gdcm::SmartPointer<gdcm::SequenceOfItems> all = new gdcm::SequenceOfItems;
    all->SetLengthToUndefined();
    for (std::size_t n = 0; n < order.size(); ++n) {
      gdcm::Item item;
      item.SetVLToUndefined();
      gdcm::DataSet place;
      put<gdcm::Attribute<0x0020, 0x0032>>(place, 0.0, 0.0, 2.0 * order[n]);
      copy({0x0020, 0x9113}, place, item);
      gdcm::DataSet turn;
      put<gdcm::Attribute<0x0020, 0x0037>>(turn, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);
      copy({0x0020, 0x9116}, turn, item);
      gdcm::DataSet measures;
      put<gdcm::Attribute<0x0028, 0x0030>>(measures, 1.0, 0.5);
      copy({0x0028, 0x9110}, measures, item);
      gdcm::DataSet rescale;
      put_one<gdcm::Attribute<0x0028, 0x1053>>(rescale, slope(static_cast<int>(n)));
      put_one<gdcm::Attribute<0x0028, 0x1052>>(rescale, offset(static_cast<int>(n)));
      copy({0x0028, 0x9145}, rescale, item);
      all->AddItem(item);
    }
    gdcm::DataElement element(gdcm::Tag(0x5200, 0x9230));
    element.SetVR(gdcm::VR::SQ);
    element.SetValue(*all);
    element.SetVLToUndefined();
    return element;
  }
  void write(const std::filesystem::path& file) const {
    gdcm::Writer writer;
    gdcm::DataSet& set = writer.GetFile().GetDataSet();
    writer.GetFile().GetHeader().SetDataSetTransferSyntax(
        gdcm::TransferSyntax::ExplicitVRLittleEndian);
    put_one<gdcm::Attribute<0x0008, 0x0016>>(
        set, enhanced ? "1.2.840.10008.5.1.4.1.1.2.1" : "1.2.840.10008.5.1.4.1.1.2");
    put_one<gdcm::Attribute<0x0008, 0x0018>>(set, "1.2.3.4");
    put_one<gdcm::Attribute<0x0008, 0x0060>>(set, "CT");
    put_one<gdcm::Attribute<0x0020, 0x000e>>(set, "1.2.3");
    put_one<gdcm::Attribute<0x0028, 0x0002>>(set, 1);
    put_one<gdcm::Attribute<0x0028, 0x0004>>(set, "MONOCHROME2");
    put_one<gdcm::Attribute<0x0028, 0x0008>>(set, static_cast<int>(order.size()));
    put_one<gdcm::Attribute<0x0028, 0x0010>>(set, kPixels);
    put_one<gdcm::Attribute<0x0028, 0x0011>>(set, kPixels);
    put_one<gdcm::Attribute<0x0028, 0x0100>>(set, 16);
    put_one<gdcm::Attribute<0x0028, 0x0101>>(set, 16);
    put_one<gdcm::Attribute<0x0028, 0x0102>>(set, 15);
    put_one<gdcm::Attribute<0x0028, 0x0103>>(set, 0);
    if (padding) {
      const auto value = static_cast<std::uint16_t>(*padding);
      gdcm::DataElement element(gdcm::Tag(0x0028, 0x0120));
      element.SetVR(gdcm::VR::US);
      element.SetByteValue(reinterpret_cast<const char*>(&value), sizeof value);
      set.Insert(element);
    }
    if (enhanced) {
      set.Insert(groups());
    } else {
      put<gdcm::Attribute<0x0020, 0x0032>>(set, 0.0, 0.0, 0.0);
      put<gdcm::Attribute<0x0020, 0x0037>>(set, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);
      put<gdcm::Attribute<0x0028, 0x0030>>(set, 1.0, 0.5);
      put_one<gdcm::Attribute<0x0028, 0x1052>>(set, -1024.0);
      put_one<gdcm::Attribute<0x0028, 0x1053>>(set, 1.0);
      if (distance) {
        put_one<gdcm::Attribute<0x0018, 0x0088>>(set, *distance);
      }
    }
    const std::vector<std::uint16_t> stored = pixels();
    gdcm::DataElement data(gdcm::Tag(0x7fe0, 0x0010));
    data.SetVR(gdcm::VR::OW);
    data.SetByteValue(reinterpret_cast<const char*>(stored.data()),
                      static_cast<unsigned>(stored.size() * sizeof(std::uint16_t)));
    set.Insert(data);
    writer.SetFileName(file.c_str());
    writer.SetCheckFileMetaInformation(true);
    ASSERT_TRUE(writer.Write());
  }
};

class DicomFramesTest : public DicomTest {
 protected:
  static std::vector<int> slices(const std::function<int(int)>& of) {
    std::vector<int> order;
    for (int k = 0; k < kSize; ++k) {
      order.push_back(of(k));
    }
    return order;
  }
  void expect_bar(const BoneModel& model) const {
    const BoneSummary summary = summary_of(model);
    EXPECT_NEAR(1e9 * summary.volume, 1920.0, 0.08 * 1920.0);
    const Eigen::Vector3d middle(0.5 * 11.5, 11.5, 2.0 * 9.5);
    EXPECT_LT((1e3 * summary.box.center() - middle).norm(), 0.3);
  }
  std::string refused() const {
    try {
      load_bone(file_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }
  std::filesystem::path file_{folder_ / "frames.dcm"};
};

TEST_F(DicomFramesTest, FramesLieWhereTheirGroupsSayWhateverTheirOrder) {
  for (const int factor : {1, 7, 23}) {
    Frames{.order = slices([&](int k) { return factor * k % kSize; })}.write(file_);
    expect_bar(load_bone(file_));
  }
}

TEST_F(DicomFramesTest, MissingFramesAreNamed) {
  Frames frames{.order = slices([](int k) { return k; })};
  frames.order.erase(frames.order.begin() + 10, frames.order.begin() + 13);
  frames.write(file_);
  EXPECT_THAT(refused(), HasSubstr("frame 10 of frames.dcm and frame 11 of frames.dcm lie 8 mm"));
}

TEST_F(DicomFramesTest, EveryFrameHasARescaleOfItsOwn) {
  const auto order = slices([](int k) { return k; });
  Frames{.order = order}.write(file_);
  const BoneModel even = load_bone(file_);
  Frames{.order = order, .rescale_step = 0.03}.write(file_);
  const BoneModel model = load_bone(file_);
  expect_bar(model);
  ASSERT_EQ(model.density.size(), even.density.size());
  for (std::size_t i = 0; i < model.density.size(); ++i) {
    ASSERT_NEAR(model.density[i], even.density[i], 0.02F);
  }
}

TEST_F(DicomFramesTest, FramesWithoutGroupsNeedTheirDistance) {
  Frames frames{.enhanced = false, .order = slices([](int k) { return k; })};
  frames.write(file_);
  EXPECT_THAT(refused(), HasSubstr("does not give the place of its slice"));
  frames.distance = 2.0;
  frames.write(file_);
  expect_bar(load_bone(file_));
}

TEST_F(DicomFramesTest, PaddingIsNoValue) {
  // Stored 50,000 would be 48,976 HU.
  for (const std::optional<int> padding : {std::optional(50'000), std::optional<int>()}) {
    Frames frames{.order = slices([](int k) { return k; }), .padding = padding};
    frames.write(file_);
    const BoneModel model = load_bone(file_);
    expect_bar(model);
    EXPECT_EQ(model.source.find("pixels of padding") != std::string::npos, padding.has_value());
  }
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

TEST_F(DicomTest, ASliceBesideTheLineIsNamed) {
  write_series(Eigen::Matrix3d::Identity());
  write("80.dcm", 10, Eigen::Matrix3d::Identity(), "1.2.3", {0.4, 0.0, 0.0});
  EXPECT_EQ(refusal(), "none") << "a fifth of the distance of slices";
  write("80.dcm", 10, Eigen::Matrix3d::Identity(), "1.2.3", {0.6, 0.0, 0.0});
  EXPECT_THAT(refusal(), HasSubstr("80.dcm lies 0.6 mm beside the line"));
}

/// Axes of slices that are tilted by an angle and still follow each other upwards [degrees].
Eigen::Matrix3d tilted(double angle) {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  const double tilt = angle * std::numbers::pi / 180.0;
  axes.col(1) = Eigen::Vector3d(0.0, std::cos(tilt), -std::sin(tilt));
  return axes;
}

TEST_F(DicomTest, ATiltedGantryIsToldByItsAngle) {
  const Eigen::Matrix3d axes = tilted(18.5);
  write_series(axes);
  const BoneModel model = load_bone(folder_.path());
  EXPECT_THAT(model.source, HasSubstr("its axes 18.50 degrees off a right angle"));
  const double exact = 1920.0 * std::abs(axes.determinant());
  EXPECT_NEAR(1e9 * summary_of(model).volume, exact, 0.08 * exact);
  const Eigen::Vector3d middle = axes * Eigen::Vector3d(0.5 * 11.5, 11.5, 2.0 * 9.5);
  EXPECT_LT((1e3 * summary_of(model).box.center() - middle).norm(), 0.7);
}

TEST_F(DicomTest, ASmallTiltIsNotKeptIfItMovesVoxels) {
  const Eigen::Matrix3d axes = tilted(1.5);  // 1.2 mm over the series
  write_series(axes);
  const BoneModel model = load_bone(folder_.path());
  EXPECT_THAT(model.source, HasSubstr("1.50 degrees off a right angle, now along the axes"));
  const Eigen::Vector3d middle = axes * Eigen::Vector3d(0.5 * 11.5, 11.5, 2.0 * 9.5);
  EXPECT_LT((1e3 * summary_of(model).box.center() - middle).norm(), 0.3);
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
