#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "analysis/contact/evaluation/prepare_contact.h"
#include "core/geometry/files/mesh_io.h"
#include "tests/support/shared_data.h"

/// Recordings of a hand that follows a known body with a tool on bearings (KU Leuven; folder
/// haptic/contour of the data from outside): columns time, position, quaternion (w first), force,
/// torque, a row for every event.
namespace haptrial::test {

using namespace evaluation;

inline ContactRecording read_contour(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  ContactRecording recording;
  while (std::getline(in, line)) {
    std::istringstream row(line);
    double t, x, y, z, qw, qx, qy, qz, fx, fy, fz, tx, ty, tz;
    row >> t >> x >> y >> z >> qw >> qx >> qy >> qz >> fx >> fy >> fz >> tx >> ty >> tz;
    if (!row || (!recording.pose.time.empty() && t <= recording.pose.time.back())) {
      continue;
    }
    recording.pose.time.push_back(t);
    recording.pose.position.emplace_back(x, y, z);
    recording.pose.orientation.push_back(Eigen::Quaterniond(qw, qx, qy, qz).normalized());
    recording.force.time.push_back(t);
    recording.force.force.emplace_back(fx, fy, fz);
    recording.force.torque.emplace_back(tx, ty, tz);
  }
  recording.pose = changes(recording.pose);
  recording.force = changes(recording.force);
  return recording;
}

/// The tool of each set-up, from the authors' calibration (configuration_properties_contour.m of
/// the repository trajectory-invariants/invariants_mat): the tool point C in the tracker's frame P,
/// the load cell S in C.
struct ContourTool {
  Eigen::Vector3d point;  // p_PC [m]
  SensorMount mount;
};

inline ContourTool contour_tool(char set_up) {
  const auto about = [](double degrees, const Eigen::Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * 3.14159265358979 / 180.0, axis));
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const double turn = set_up == 'b' || set_up == 'e' ? 180.0
                      : set_up == 'd'                ? 90.0
                      : set_up == 'f'                ? -90.0
                                                     : 0.0;
  ContourTool tool;
  tool.point = {0.0, set_up == 'a' || set_up == 'b' ? -0.09969 : -0.26169, 0.0355};
  const Eigen::Quaterniond tool_in_tracker = about(turn, y) * about(135.0, x);
  const Eigen::Quaterniond tool_in_cell = about(-90.0, z) * about(225.0, x);
  tool.mount.orientation = tool_in_tracker * tool_in_cell.conjugate();
  tool.mount.position = tool.point - tool.mount.orientation * Eigen::Vector3d(0.0, 0.0, -0.05517);
  return tool;
}

/// The authors' result for the load: 1.96138 N along -y of the tracker's world; the sensor says
/// nothing when its z axis points up.
inline SensorLoad contour_load() {
  SensorLoad load;
  load.weight = {0.0, -1.96138, 0.0};
  load.force_offset = {0.0, 0.0, 1.96138};
  return load;
}

/// The tool's points in W.
inline std::vector<Eigen::Vector3d> contour_path(const PoseStream& pose, char set_up) {
  std::vector<Eigen::Vector3d> path;
  for (std::size_t i = 0; i < pose.size(); ++i) {
    path.emplace_back(pose.position[i] + pose.orientation[i] * contour_tool(set_up).point);
  }
  return path;
}

inline std::optional<geometry::Mesh> contour_body() {
  const auto file = haptrial::test::shared_data("haptic/contour/contour.stl");
  if (!file) {
    return std::nullopt;
  }
  geometry::Mesh mesh = geometry::read_mesh(*file);
  for (auto& v : mesh.vertices) {
    v *= 1e-3;  // the file is in mm
  }
  return mesh;
}

inline PrepareOptions contour_options(char set_up) {
  PrepareOptions options;
  options.tip = contour_tool(set_up).point;
  options.mount = contour_tool(set_up).mount;
  options.load = contour_load();
  options.stiffness = 2e4;  // N/m: 20 N press by a millimetre
  return options;
}

inline std::optional<std::filesystem::path> contour_file(char set_up) {
  return haptrial::test::shared_data(std::string("haptic/contour/demo_") + set_up + "_1.dat");
}

}  // namespace haptrial::test
