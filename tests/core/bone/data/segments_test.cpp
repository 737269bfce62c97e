// Segmentations of 3D Slicer, and meshes beside a scan, land where they say.

#include "core/bone/data/segments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/bone/data/bone_summary.h"
#include "core/bone/data/load_bone.h"
#include "tests/core/bone/data/volume_bytes.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::bone {
namespace {

using test::PlainVolume;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

/// A .seg.nrrd as 3D Slicer 5 writes it: layers fastest, then the voxels of 1 mm.
std::string layered(std::array<int, 3> size, const std::vector<std::vector<std::uint8_t>>& layers,
                    const std::string& keys) {
  std::string bytes;
  for (std::size_t at = 0; at < layers.front().size(); ++at) {
    for (const auto& layer : layers) {
      bytes += static_cast<char>(layer[at]);
    }
  }
  return fmt::format(
             "NRRD0004\n# Complete NRRD file format specification at:\n"
             "# http://teem.sourceforge.net/nrrd/format.html\ntype: unsigned char\ndimension: 4\n"
             "space: left-posterior-superior\nsizes: {} {} {} {}\n"
             "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list domain domain domain\n"
             "encoding: gzip\nspace origin: (0,0,0)\n{}\n",
             layers.size(), size[0], size[1], size[2], keys) +
         test::gzip(bytes);
}

std::string segment(int number, const std::string& name, int value, int layer,
                    const std::string& colour = "0.1 0.2 0.3") {
  const std::string key = fmt::format("Segment{}_", number);
  return fmt::format(
      "{0}Color:={1}\n{0}ID:=Segment_{2}\n{0}LabelValue:={3}\n{0}Layer:={4}\n"
      "{0}Name:={5}\n{0}Extent:=0 3 0 1 0 0\n",
      key, colour, number, value, layer, name);
}

class SegmentsTest : public ::testing::Test {
 protected:
  BoneModel load(const std::string& name, const std::string& bytes,
                 const LoadOptions& options = {}) {
    test::write_bytes(folder_ / name, bytes);
    return load_bone(folder_ / name, options);
  }
  std::string name_at(const BoneModel& model, const Eigen::Vector3d& place_mm) {
    const Eigen::Vector3i at =
        ((1e-3 * place_mm - model.grid.origin) / model.grid.spacing).array().round().cast<int>();
    return model.structures[model.labels[model.grid.index(at)]].name;
  }
  test::TemporaryFolder folder_;
};

TEST_F(SegmentsTest, LayersOfAnyNumberBecomeOneLabelPerVoxel) {
  // Four voxels in a row: bone, bone and nerve, nerve and lump, lump. Values repeat in layers.
  const std::string keys = segment(0, "Facial_Nerve", 1, 2) + segment(1, "Bone", 1, 0) +
                           segment(2, "Lump", 1, 1, "0.5 0.25 1");
  const BoneModel model =
      load("s.seg.nrrd", layered({4, 1, 1}, {{1, 1, 0, 0}, {0, 0, 1, 1}, {0, 1, 1, 0}}, keys));
  std::vector<std::string> names;
  for (const std::uint8_t label : model.labels) {
    names.push_back(model.structures[label].name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"bone", "facial nerve", "Lump", "Lump"}));
  EXPECT_TRUE(model.structures[1].vital);
  EXPECT_EQ(model.structures[3].colour, (std::array<double, 3>{0.5, 0.25, 1.0}));
  EXPECT_THAT(model.source, HasSubstr("3 layers that share 2 voxels"));
}

// 3D Slicer leaves a gap in the numbers where a segment was deleted.
TEST_F(SegmentsTest, ADeletedSegmentShiftsNoName) {
  const std::string keys = segment(0, "Bone", 1, 0) + segment(2, "Facial_Nerve", 1, 1);
  const BoneModel model =
      load("s.seg.nrrd", layered({4, 1, 1}, {{1, 1, 1, 0}, {0, 0, 0, 1}}, keys));
  EXPECT_EQ(name_at(model, {0, 0, 0}), "bone");
  EXPECT_EQ(name_at(model, {3, 0, 0}), "facial nerve");
  const std::string first_gone = segment(1, "Bone", 1, 0) + segment(2, "Facial_Nerve", 1, 1);
  const BoneModel other = load("t.seg.nrrd", layered({2, 1, 1}, {{1, 0}, {0, 1}}, first_gone));
  EXPECT_EQ(name_at(other, {0, 0, 0}), "bone");
  EXPECT_EQ(name_at(other, {1, 0, 0}), "facial nerve");
}

TEST_F(SegmentsTest, ASegmentWithoutItsLayerIsRefused) {
  const std::string bytes = layered({2, 1, 1}, {{1, 0}, {0, 1}}, segment(0, "Bone", 1, 2));
  EXPECT_THAT(test::message_of([&] { load("s.seg.nrrd", bytes); }),
              HasSubstr("segment 0 has value '1' in layer '2'; allowed: values 1 to 255 in layers "
                        "0 to 1"));
  const std::string bare = layered({2, 1, 1}, {{1, 0}, {0, 1}, {0, 0}}, "");
  EXPECT_THAT(test::message_of([&] { load("s.seg.nrrd", bare); }), HasSubstr("one value per"));
}

/// A scan of 1 mm whose bone is a cube; its axes are turned.
PlainVolume scan(double degrees) {
  PlainVolume volume({30, 30, 30});
  volume.steps =
      Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Eigen::Vector3d(1, 2, 3).normalized())
          .toRotationMatrix();
  volume.origin = {-3, 4, 5};
  volume.fill([](const Eigen::Vector3d& p) {
    return (p - Eigen::Vector3d(11, 18, 19)).cwiseAbs().maxCoeff() < 7.0 ? 1600 : -900;
  });
  return volume;
}

TEST_F(SegmentsTest, ASegmentationNamesAScanInItsPlaceHoweverBothAreTurned) {
  const Eigen::Vector3d middle(11, 18, 19);
  for (const double degrees : {0.0, 0.8, 25.0}) {
    PlainVolume segments({50, 50, 50});  // other voxels, other axes
    segments.steps = Eigen::Vector3d(-0.5, 0.6, 0.5).asDiagonal();
    segments.origin = {23, 4, 7};
    segments.more = segment(0, "Facial_Nerve", 3, 0);
    segments.fill(
        [&](const Eigen::Vector3d& p) { return (p - middle).head<2>().norm() < 2.5 ? 3 : 0; });
    test::write_bytes(folder_ / "ear.seg.nrrd", nrrd_of(segments, true));
    LoadOptions options;
    options.segments = folder_ / "ear.seg.nrrd";
    const BoneModel model = load("scan.nrrd", nrrd_of(scan(degrees)), options);
    const auto nerve = std::ranges::find(model.structures, "facial nerve", &Structure::name);
    ASSERT_NE(nerve, model.structures.end());
    const BoneSummary summary = summary_of(model);
    const StructureSummary& found = summary.structures.back();
    const double exact =  // as the segmentation holds it
        0.5 * 0.6 * 0.5 * static_cast<double>(std::ranges::count(segments.values, 3));
    EXPECT_NEAR(1e9 * found.volume, exact, 0.05 * exact) << degrees;
    // Below 1 degree the volume's own axes are B's: its first voxel keeps its place only.
    const double play = degrees == 0.8 ? 0.8 : 0.3;
    EXPECT_LT((1e3 * found.box.center() - Eigen::Vector3d(11, 18, 19.25)).norm(), play) << degrees;
    EXPECT_FLOAT_EQ(model.density[model.grid.index(0, 0, 0)], 0.0F);
    EXPECT_THAT(model.source, HasSubstr("segments of ear.seg.nrrd"));
  }
}

// Half of the nerve and all of the incus lie beyond the scan.
TEST_F(SegmentsTest, WhatLiesBeyondTheScanIsSaid) {
  PlainVolume segments({60, 30, 30});
  segments.origin = {-3, 4, 5};
  segments.more = segment(0, "Facial_Nerve", 3, 0) + segment(1, "Incus", 4, 0);
  segments.fill([&](const Eigen::Vector3d& p) {
    const bool row = p.y() == 18.0 && p.z() == 19.0;
    return row && p.x() >= 17.0 && p.x() < 37.0 ? 3 : row && p.x() >= 40.0 ? 4 : 0;
  });
  test::write_bytes(folder_ / "ear.seg.nrrd", nrrd_of(segments));
  LoadOptions options;
  options.spacing = 1e-3;
  options.segments = folder_ / "ear.seg.nrrd";
  const std::string file = options.segments.string();
  const BoneModel model = load("scan.nrrd", nrrd_of(scan(0.0)), options);
  EXPECT_THAT(model.notes,
              ElementsAre("facial nerve, a vital structure, is lost in part: 20.0 mm3 in " + file +
                              ", 10.0 mm3 here",
                          StartsWith("incus, a vital structure, is lost: 17.0 mm3 in " + file +
                                     ", none here")));
  options.crop =
      Eigen::AlignedBox3d(1e-3 * Eigen::Vector3d(-10, 0, 0), 1e-3 * Eigen::Vector3d(25, 50, 50));
  EXPECT_THAT(load("scan.nrrd", nrrd_of(scan(0.0)), options).notes, IsEmpty());  // as asked
}

TEST_F(SegmentsTest, ASegmentOfBoneReplacesTheThreshold) {
  PlainVolume segments({30, 30, 30});
  segments.origin = {-3, 4, 5};
  segments.more = segment(0, "bone", 1, 0);
  segments.fill([](const Eigen::Vector3d& p) { return p.x() < 11.5 ? 1 : 0; });
  test::write_bytes(folder_ / "bone.seg.nrrd", nrrd_of(segments));
  LoadOptions options;
  options.segments = folder_ / "bone.seg.nrrd";
  options.spacing = 1e-3;
  const BoneModel model = load("scan.nrrd", nrrd_of(scan(0.0)), options);
  EXPECT_EQ(summary_of(model).voxels, 15U * 30U * 30U);
  const auto [least, most] = std::ranges::minmax_element(model.density, [](float a, float b) {
    return (a == 0.0F ? 2.0F : a) < (b == 0.0F ? 2.0F : b);
  });
  EXPECT_FLOAT_EQ(*least, 0.2F);
  EXPECT_THAT(test::message_of([&] {
                PlainVolume far = segments;
                far.origin = {200, 0, 0};
                test::write_bytes(folder_ / "bone.seg.nrrd", nrrd_of(far));
                load("scan.nrrd", nrrd_of(scan(0.0)), options);
              }),
              HasSubstr("has no segment in the bone; it spans 200.0"));
}

/// A closed box as ASCII STL.
std::string stl_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                    const std::string& head) {
  std::string text = "solid " + head + "\n";
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool top : {false, true}) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      const auto corner = [&](bool at_u, bool at_v) {
        Eigen::Vector3d p = low;
        p[axis] = top ? high[axis] : low[axis];
        p[u] = at_u ? high[u] : low[u];
        p[v] = at_v ? high[v] : low[v];
        return fmt::format("  vertex {} {} {}\n", p.x(), p.y(), p.z());
      };
      const std::array<std::string, 4> c{corner(false, false), corner(top, !top),
                                         corner(true, true), corner(!top, top)};
      for (const auto& [a, b] : {std::pair{1, 2}, {2, 3}}) {
        text += "facet normal 0 0 0\n outer loop\n" + c[0] + c[static_cast<std::size_t>(a)] +
                c[static_cast<std::size_t>(b)] + " endloop\nendfacet\n";
      }
    }
  }
  return text + "endsolid\n";
}

TEST_F(SegmentsTest, AMeshBecomesAStructureOfItsVolumeInItsPlace) {
  const Eigen::Vector3d low(8.2, 15.3, 16.1);
  const Eigen::Vector3d high(12.7, 20.3, 21.6);
  test::write_bytes(folder_ / "lps.stl", stl_box(low, high, "scene"));
  const Eigen::Vector3d ras(-1, -1, 1);
  const Eigen::Vector3d a = ras.cwiseProduct(low);
  const Eigen::Vector3d b = ras.cwiseProduct(high);
  test::write_bytes(folder_ / "ras.stl", stl_box(a.cwiseMin(b), a.cwiseMax(b), "SPACE=RAS"));
  for (const char* file : {"lps.stl", "ras.stl"}) {
    for (const double degrees : {0.0, 25.0}) {
      LoadOptions options;
      options.meshes = {{"cn vii", folder_ / file, {}}};
      const BoneModel model = load("scan.nrrd", nrrd_of(scan(degrees)), options);
      const StructureSummary found = summary_of(model).structures.back();
      EXPECT_EQ(model.structures[found.label].name, "facial nerve");
      const double exact = 4.5 * 5.0 * 5.5;
      EXPECT_NEAR(1e9 * found.volume, exact, 0.06 * exact) << file << degrees;
      EXPECT_LT((1e3 * found.box.center() - 0.5 * (low + high)).norm(), 0.3) << file << degrees;
      EXPECT_DOUBLE_EQ(found.mean_density, 1.0);
      EXPECT_THAT(model.notes, IsEmpty());
    }
  }
  test::write_bytes(folder_ / "far.stl", stl_box({21, 15, 16}, {31, 20, 21}, "scene"));
  LoadOptions beyond;
  beyond.spacing = 1e-3;
  beyond.meshes = {{"cn vii", folder_ / "far.stl", {}}};
  EXPECT_THAT(
      load("scan.nrrd", nrrd_of(scan(0.0)), beyond).notes,
      ElementsAre(AllOf(HasSubstr("facial nerve, a vital structure, is lost in part: 250.0"),
                        HasSubstr("far.stl, "))));
  LoadOptions wrong;
  wrong.meshes = {{"cn vii", folder_ / "lps.stl", true}};
  EXPECT_THAT(test::message_of([&] { load("scan.nrrd", nrrd_of(scan(0.0)), wrong); }),
              AllOf(HasSubstr("lps.stl: holds no voxel's centre; it spans -12.7 -20.3 16.1 to"),
                    HasSubstr("check unit (mm) and axes (LPS or RAS)")));
}

TEST_F(SegmentsTest, WhatIsCroppedLiesWhereItLay) {
  for (const double degrees : {0.0, 0.8, 25.0}) {
    PlainVolume volume = scan(degrees);
    for (const bool grey : {true, false}) {
      for (std::int16_t& value : volume.values) {
        value = static_cast<std::int16_t>(grey || value < 0 ? value : 7);
        value = static_cast<std::int16_t>(!grey && value < 0 ? 0 : value);
      }
      LoadOptions options;
      options.spacing = 1e-3;
      const BoneModel whole = load("scan.nrrd", nrrd_of(volume), options);
      options.crop = Eigen::AlignedBox3d(1e-3 * Eigen::Vector3d(8.7, 10.2, 19.6),
                                         1e-3 * Eigen::Vector3d(14.3, 40, 23.4));
      const BoneModel part = load("scan.nrrd", nrrd_of(volume), options);
      std::size_t inside = 0;
      const geometry::VoxelGrid& grid = whole.grid;
      geometry::visit_voxels(grid, [&](const Eigen::Vector3i& voxel, std::size_t at) {
        const Eigen::Vector3d p = 1e3 * grid.centre(voxel);
        if (whole.labels[at] != 0 && options.crop->contains(1e-3 * p)) {
          ++inside;
          EXPECT_EQ(name_at(part, p), name_at(whole, p)) << p.transpose();
        }
      });
      EXPECT_GT(inside, 50U);
      EXPECT_EQ(summary_of(part).voxels, inside) << degrees << grey;
      EXPECT_THAT(part.source, HasSubstr("cropped"));
    }
  }
  LoadOptions beside;
  beside.crop = Eigen::AlignedBox3d(Eigen::Vector3d::Constant(1.0), Eigen::Vector3d::Constant(2.0));
  EXPECT_THAT(test::message_of([&] { load("scan.nrrd", nrrd_of(scan(0.0)), beside); }),
              HasSubstr("the box to crop holds none of its voxels, which span -3.0 4.0 5.0 to"));
}

TEST_F(SegmentsTest, WhatIsFoundOfGreyNumbersIsToldEvenWhereTheyAreRefused) {
  PlainVolume volume({20, 20, 20});
  volume.fill([](const Eigen::Vector3d& p) {
    return p.x() < 8 ? 10.0 + p.y() : p.x() < 14 ? 1000.0 + p.y() : 2000.0 + p.y();
  });
  int told = 0;
  LoadOptions options;
  options.findings = [&](const GreyFindings& found) {
    ++told;
    EXPECT_FALSE(found.used);
    EXPECT_GT(found.suggested, 1019.0);
    EXPECT_LT(found.suggested, 2000.0);
    double all = 0.0;
    for (const double count : found.histogram.counts) {
      all += count;
    }
    EXPECT_DOUBLE_EQ(all, 8000.0);
  };
  EXPECT_THAT(test::message_of([&] { load("v.nrrd", nrrd_of(volume), options); }),
              HasSubstr("not Hounsfield units"));
  EXPECT_EQ(told, 1);
}

}  // namespace
}  // namespace haptrial::bone
