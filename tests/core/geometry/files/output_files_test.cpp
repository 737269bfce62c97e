#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "core/base/error.h"
#include "core/geometry/files/tet_files.h"
#include "core/geometry/files/volume_files.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/voxelize.h"
#include "tests/support/temporary_folder.h"

// Our files are read by programs that are not ours.
namespace haptrial::geometry {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

VoxelSolid torus() {
  const Mesh mesh = make_torus(0.05, 0.02, 40, 20);
  return voxelize(mesh, make_grid(bounds(mesh), 21, 1), InsideRule::kParity);
}

std::string output(const std::string& command, const test::TemporaryFolder& folder) {
  const std::string file = (folder / "output").string();
  if (std::system((command + " > '" + file + "' 2>&1").c_str()) != 0) {
    return "failed: " + command;
  }
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::size_t count_files(const std::filesystem::path& folder) {
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) {
    ++files;
  }
  return files;
}

/// Points, tetrahedra, total volume, least volume and points on the surface, as another program
/// that read the file finds them.
constexpr const char* kMeasure = R"(
import sys, numpy
def say(points, tets, surface):
    points, tets = numpy.asarray(points), numpy.asarray(tets)
    a, b, c, d = (points[tets[:, n]] for n in range(4))
    volume = numpy.einsum('ij,ij->i', b - a, numpy.cross(c - a, d - a)) / 6
    print(len(points), len(tets), '%.9g %.9g' % (volume.sum(), volume.min()), surface)
)";

std::string expected(const TetMesh& mesh, const VoxelSolid& solid) {
  const double voxel = std::pow(solid.grid.spacing, 3);
  const auto tagged = std::count(mesh.on_surface.begin(), mesh.on_surface.end(), 1);
  return fmt::format("{} {} {:.9g} {:.9g} {}\n", mesh.vertices.size(), mesh.tetrahedra.size(),
                     voxel * static_cast<double>(count_inside(solid)), voxel / 6.0, tagged);
}

class TetFilesTest : public ::testing::TestWithParam<const char*> {};

TEST_P(TetFilesTest, MeshioReadsIt) {
  const test::TemporaryFolder folder;
  const VoxelSolid solid = torus();
  const TetMesh mesh = tetrahedralize(solid);
  const auto file = folder / ("torus." + std::string(GetParam()));
  write_tet_mesh(file, mesh);
  std::ofstream(folder / "read.py") << kMeasure << R"(
import meshio
mesh = meshio.read(sys.argv[1])
names = [n for n in mesh.point_data if n in ('on_surface', 'tetgen:ref')]
say(mesh.points, mesh.cells_dict['tetra'], int(mesh.point_data[names[0]].sum()))
)";
  const std::string command =
      fmt::format("/usr/bin/python3 '{}' '{}'", (folder / "read.py").string(), file.string());
  EXPECT_THAT(output(command, folder), EndsWith(expected(mesh, solid)));
}

INSTANTIATE_TEST_SUITE_P(Formats, TetFilesTest, ::testing::Values("node", "ele", "vtu"));

TEST(TetFieldsTest, MeshioReadsThem) {
  const test::TemporaryFolder folder;
  const TetMesh mesh = tetrahedralize(torus());
  TetField way{"way", 3, {}};
  TetField stress{"stress", 6, {}};
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      way.values.push_back(2.0 * mesh.vertices[v][axis]);
    }
  }
  for (std::size_t t = 0; t < 6 * mesh.tetrahedra.size(); ++t) {
    stress.values.push_back(static_cast<double>(t));
  }
  write_vtu(folder / "a.vtu", mesh, {way}, {stress});
  std::ofstream(folder / "read.py") << R"(
import meshio, sys
mesh = meshio.read(sys.argv[1])
stress = mesh.cell_data['stress'][0]
print(abs(mesh.point_data['way'] - 2 * mesh.points).max(), stress.shape[1],
      int(stress[-1, 5]) + 1 == stress.size)
)";
  const std::string command = fmt::format(
      "/usr/bin/python3 '{}' '{}'", (folder / "read.py").string(), (folder / "a.vtu").string());
  EXPECT_THAT(output(command, folder), EndsWith("0.0 6 True\n"));
  stress.values.pop_back();
  EXPECT_THROW(write_vtu(folder / "b.vtu", mesh, {way}, {stress}), std::invalid_argument);
}

TEST(TetFilesHdf5Test, H5pyReadsIt) {
  const test::TemporaryFolder folder;
  const VoxelSolid solid = torus();
  const TetMesh mesh = tetrahedralize(solid);
  write_tet_mesh(folder / "torus.h5", mesh);
  write_volume(folder / "volume.h5", volume_of(solid));
  std::ofstream(folder / "read.py") << kMeasure << R"(
import h5py
f = h5py.File(sys.argv[1] + '/torus.h5')
say(f['vertices'], f['tetrahedra'], int(f['on_surface'][:].sum()))
v = h5py.File(sys.argv[1] + '/volume.h5')['volume']
print(v.shape, int((v[:] == 1).sum()), '%.9g' % v.attrs['spacing_m'][0])
)";
  const std::string command =
      fmt::format("/usr/bin/python3 '{0}/read.py' '{0}'", folder.path().string());
  const auto& size = solid.grid.size;
  EXPECT_EQ(output(command, folder),
            expected(mesh, solid) + fmt::format("({}, {}, {}) {} {:.9g}\n", size[2], size[1],
                                                size[0], count_inside(solid), solid.grid.spacing));
}

TEST(VolumeFilesTest, UnuReadsIt) {
  const test::TemporaryFolder folder;
  const VoxelSolid solid = torus();
  write_volume(folder / "torus.nrrd", volume_of(solid));
  const std::string file = "'" + (folder / "torus.nrrd").string() + "'";
  const auto& size = solid.grid.size;
  const std::string head = output("teem-unu head " + file, folder);
  EXPECT_THAT(head, HasSubstr(fmt::format("sizes: {} {} {}\n", size[0], size[1], size[2])));
  EXPECT_THAT(head, HasSubstr("space units: \"m\" \"m\" \"m\"\n"));
  const auto inside = static_cast<double>(count_inside(solid));
  const auto border = static_cast<double>(
      std::count(solid.labels.begin(), solid.labels.end(), VoxelLabel::kBorder));
  const double mean = (inside + 2.0 * border) / static_cast<double>(solid.labels.size());
  const std::string found = output("teem-unu project -a 2 -m mean -t double -i " + file +
                                       " | teem-unu project -a 1 -m mean | teem-unu project -a 0 "
                                       "-m mean | teem-unu save -f text",
                                   folder);
  EXPECT_NEAR(std::atof(found.c_str()), mean, 1e-5 * mean);
  // A slice through the middle keeps its order: along x first.
  const std::string row = output(
      fmt::format("teem-unu slice -a 2 -p {} -i {} | teem-unu slice -a 1 -p {} | teem-unu save -f "
                  "text",
                  size[2] / 2, file, size[1] / 3),
      folder);
  std::string ours;
  for (std::int32_t i = 0; i < size[0]; ++i) {
    ours += fmt::format(
        "{}\n", static_cast<int>(solid.labels[solid.grid.index(i, size[1] / 3, size[2] / 2)]));
  }
  EXPECT_EQ(row, ours);
}

TEST(VolumeFilesTest, VectorsHaveTheirComponentsSideBySide) {
  const test::TemporaryFolder folder;
  const VoxelGrid grid{{2, 1, 1}, {0, 0, 0}, 1.0};
  const std::vector<float> values{1, 2, 3, 4, 5, 6};
  write_volume(folder / "v.nrrd", {grid, std::span<const float>(values), 3, "points [m]"});
  EXPECT_EQ(output("teem-unu slice -a 0 -p 1 -i '" + (folder / "v.nrrd").string() +
                       "' | teem-unu reshape -s 2 | teem-unu save -f text",
                   folder),
            "2\n5\n");
}

TEST(OutputFilesTest, NothingIsOverwrittenUnlessAskedAndNothingIsLeftHalfWritten) {
  const test::TemporaryFolder folder;
  const VoxelSolid solid = torus();
  const TetMesh mesh = tetrahedralize(solid);
  for (const char* name : {"a.vtu", "a.h5", "a.node"}) {
    const std::size_t before = count_files(folder.path());
    int calls = 0;
    EXPECT_THROW(write_tet_mesh(folder / name, mesh, false, [&](double) { return ++calls < 2; }),
                 Cancelled);
    EXPECT_EQ(count_files(folder.path()), before) << name;
    write_tet_mesh(folder / name, mesh);
    EXPECT_THROW(write_tet_mesh(folder / name, mesh), InputError);
    write_tet_mesh(folder / name, mesh, true);
  }
  EXPECT_EQ(count_files(folder.path()), 4u) << "TetGen has two";
  write_volume(folder / "b.nrrd", volume_of(solid));
  EXPECT_THROW(write_volume(folder / "b.nrrd", volume_of(solid)), InputError);
  EXPECT_THROW(write_volume(folder / "b.vti", volume_of(solid)), InputError);
  EXPECT_THROW(write_tet_mesh(folder / "b.stl", mesh), InputError);
  EXPECT_THROW(write_tet_mesh(folder / "none" / "b.vtu", mesh), InputError);
}

TEST(OutputFilesTest, ALinkThatWaitsUnderThePartsNameIsNotFollowed) {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", folder / "a.vtu.partial-1");
  write_tet_mesh(folder / "a.vtu", tetrahedralize(torus()));
  EXPECT_GT(std::filesystem::file_size(folder / "a.vtu"), 1000u);
}

}  // namespace
}  // namespace haptrial::geometry
