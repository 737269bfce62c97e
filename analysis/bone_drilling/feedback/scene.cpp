#include "analysis/bone_drilling/feedback/scene.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "analysis/bone_drilling/feedback/scene_mesh.h"
#include "analysis/document/html.h"

namespace haptrial::analysis::drilling {
namespace {

using nlohmann::json;

constexpr std::size_t kBoneTriangles = 50000;  // at most, so that two bones are below 5 MB
constexpr std::size_t kStructureTriangles = 3000;
constexpr std::size_t kPlanned = 20000;   // places of planned bone that is left, evenly chosen
constexpr std::size_t kRemovals = 60000;  // that are drawn, each with an equal share; faults first

class Scene {
 public:
  explicit Scene(const Findings& findings) : f_(findings), left_(*findings.summary.bone) {
    left_.labels = f_.labels_left;
    left_.density.clear();
    Eigen::AlignedBox3d box;
    const auto& size = left_.grid.size;
    for (const int k : {-1, size[2]}) {
      for (const int j : {-1, size[1]}) {
        for (const int i : {-1, size[0]}) {
          box.extend(f_.pose_WB * left_.grid.centre(i, j, k));
        }
      }
    }
    for (const auto& path : f_.strokes) {
      for (const Eigen::Vector3f& place : path) {
        box.extend(place.cast<double>());
      }
    }
    grid_ = SceneGrid::around(box);
  }

  json made(const FirstView& view) {
    const auto numbers = [](const Eigen::Vector3d& v) { return json{v.x(), v.y(), v.z()}; };
    json scene;
    scene["low"] = numbers(1e3 * grid_.low);  // [mm]
    scene["step"] = 1e3 * grid_.step;
    scene["eye"] = numbers(view.towards_eye.normalized());
    scene["up"] = numbers(view.up.normalized());
    scene["edge"] = 1e3 * left_.grid.spacing;
    add_focus(scene);
    scene["bone"] = mesh(scene_surface(left_, kBoneTriangles));
    scene["colours"] = json::array();
    for (const bone::Structure& structure : left_.structures) {
      scene["colours"].push_back(structure.colour);
    }
    add_structures(scene);
    add_removals(scene);
    add_planned(scene);
    add_strokes(scene);
    return scene;
  }

 private:
  Eigen::Vector3d place(const bone::Voxel& v) const { return f_.pose_WB * left_.grid.centre(v); }

  /// The removed bone, or all of it where nothing was removed.
  void add_focus(json& scene) const {
    Eigen::AlignedBox3d box;
    for (const bone::Voxel& voxel : f_.voxels) {
      box.extend(place(voxel));
    }
    if (box.isEmpty()) {
      box.extend(place(bone::Voxel::Zero()));
      box.extend(place(left_.grid.last()));
    }
    const Eigen::Vector3d middle = 1e3 * box.center();
    scene["focus"] = {middle.x(), middle.y(), middle.z()};
    scene["radius"] = 0.5e3 * box.diagonal().norm();
  }

  json mesh(const SceneMesh& m) const {
    std::string places, triangles;
    for (const auto& place : m.places) {
      grid_.add(f_.pose_WB * Eigen::Vector3d(place[0], place[1], place[2]), places);
    }
    for (const auto& triangle : m.triangles) {
      for (const std::uint16_t corner : triangle) {
        triangles += static_cast<char>(corner & 0xFFU);
        triangles += static_cast<char>(corner >> 8U);
      }
    }
    return {{"v", base64(places)},
            {"t", base64(triangles)},
            {"l", base64({reinterpret_cast<const char*>(m.labels.data()), m.labels.size()})}};
  }

  void add_structures(json& scene) const {
    scene["structures"] = json::array();
    for (const std::string& name : f_.structures) {
      std::vector<bool> wanted(left_.structures.size(), false);
      for (std::size_t label = 1; label < wanted.size(); ++label) {
        wanted[label] = left_.structures[label].name == name;
      }
      json structure = mesh(scene_structure(left_, wanted, kStructureTriangles));
      structure["name"] = name;
      scene["structures"].push_back(std::move(structure));
    }
  }

  void add_removals(json& scene) const {
    std::vector<std::size_t> order(f_.voxels.size());
    std::iota(order.begin(), order.end(), 0);
    if (order.size() > kRemovals) {
      std::stable_partition(order.begin(), order.end(),
                            [this](std::size_t n) { return f_.faults[n] != 0; });
      const std::size_t faults = std::min(f_.count(0xFF), kRemovals);
      const std::size_t others = kRemovals - faults;
      for (std::size_t n = 0; n < others; ++n) {  // an even choice of the good ones
        order[faults + n] = order[faults + n * (order.size() - faults) / others];
      }
      order.resize(kRemovals);
    }
    std::string places, faults, parts;
    for (const std::size_t n : order) {
      if (f_.plan) {
        const bone::Voxel& v = f_.voxels[n];
        parts += static_cast<char>(f_.plan->parts[left_.grid.index(v)]);
      }
      grid_.add(place(f_.voxels[n]), places);
      faults += static_cast<char>(f_.faults[n]);
    }
    scene["removals"] = {{"p", base64(places)},
                         {"f", base64(faults)},
                         {"plan", base64(parts)},
                         {"all", f_.voxels.size()}};
  }

  /// Planned bone that is left.
  void add_planned(json& scene) const {
    if (!f_.plan) {
      return;
    }
    std::vector<bone::Voxel> left;
    geometry::visit_voxels(left_.grid, [&](const bone::Voxel& voxel, std::size_t at) {
      if (f_.plan->parts[at] == subject::PlanPart::kPlanned && left_.labels[at] != 0) {
        left.push_back(voxel);
      }
    });
    const std::size_t shown = std::min(left.size(), kPlanned);
    std::string places;
    for (std::size_t n = 0; n < shown; ++n) {
      grid_.add(place(left[n * left.size() / shown]), places);
    }
    scene["planned"] = {{"p", base64(places)}, {"all", left.size()}};
  }

  void add_strokes(json& scene) const {
    constexpr std::size_t kMost = 40000;  // places of all paths
    std::string places;
    json counts = json::array();
    std::size_t all = 0;
    for (const auto& path : f_.strokes) {
      all += path.size();
      if (all > kMost) {
        break;
      }
      for (const Eigen::Vector3f& each : path) {
        grid_.add(each.cast<double>(), places);
      }
      counts.push_back(path.size());
    }
    scene["strokes"] = {{"p", base64(places)}, {"n", counts}, {"all", f_.strokes.size()}};
  }

  const Findings& f_;
  bone::BoneModel left_;
  SceneGrid grid_;
};

}  // namespace

std::string scene_json(const Findings& findings, const FirstView& view) {
  std::string text =
      Scene(findings).made(view).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos; at += 6) {
    text.replace(at, 1, "\\u003c");
  }
  return text;
}

}  // namespace haptrial::analysis::drilling
