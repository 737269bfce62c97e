#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace haptrial::test {

/// The Truth Cube (Kerdok et al. 2003): 7 x 7 x 7 beads in a cube of silicone with sides of 80 mm,
/// E 15.3 kPa, nu 0.499, at rest and under three compressions. The file's i runs along x, j along y
/// and k against z; the cube is compressed along z.
struct TruthCube {
  static constexpr double kSide = 0.080;  // [m]
  static constexpr std::size_t kStates = 3;
  struct Bead {
    std::array<int, 3> place;                    // i, j, k from 1
    Eigen::Vector3d rest;                        // [m]
    std::array<Eigen::Vector3d, kStates> moved;  // where it is in each state [m]
    bool at_an_end() const { return place[2] == 1 || place[2] == 7; }
  };
  std::vector<Bead> beads;
};

inline TruthCube read_truth_cube(const std::filesystem::path& file) {
  TruthCube cube;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    for (char& c : line) {
      c = c == ',' ? ' ' : c;
    }
    std::istringstream words(line);
    TruthCube::Bead bead;
    Eigen::Vector3d* points[] = {&bead.rest, &bead.moved[0], &bead.moved[1], &bead.moved[2]};
    words >> bead.place[0] >> bead.place[1] >> bead.place[2];
    for (Eigen::Vector3d* p : points) {
      words >> p->x() >> p->y() >> p->z();
      *p *= 1e-3;  // the file is in mm
    }
    if (words) {
      cube.beads.push_back(bead);
    }
  }
  return cube;
}

}  // namespace haptrial::test
