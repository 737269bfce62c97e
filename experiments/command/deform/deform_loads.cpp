#include "experiments/command/deform/deform_loads.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <limits>

#include "analysis/contact/recording/session_contact.h"
#include "core/base/error.h"
#include "core/base/longest_of.h"
#include "core/base/nearest.h"
#include "core/record/read/session_reader.h"

namespace haptrial::experiments {
namespace {

using Eigen::Vector3d;

constexpr double kFelt = 0.05;  // of the largest force: the tool touches

constexpr double kElsewhere = 0.1;  // of the body's size: a touch so far from it is of another body

/// @throws InputError where the tool is far from the body
std::int32_t nearest_outside(const geometry::TetMesh& mesh, const Vector3d& place,
                             const std::string& load) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  std::int32_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double way = (mesh.vertices[v] - place).norm();
    if (mesh.on_surface[v] != 0 && way < least) {
      least = way;
      best = static_cast<std::int32_t>(v);
    }
  }
  if (least > kElsewhere * box.diagonal().norm()) {
    throw InputError(
        fmt::format("load '{}': the tool touches ({:.4g}, {:.4g}, {:.4g}) m, {:.3g} m from the "
                    "body; it must stand where the object stood in the session (body.shift)",
                    load, place.x(), place.y(), place.z(), least));
  }
  return best;
}

/// Samples in which the tool is felt, evenly over them.
std::vector<std::size_t> moments(const evaluation::ForceStream& force, int count) {
  const double most = longest_of(force.force);
  std::vector<std::size_t> felt;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (most > 0.0 && force.force[i].norm() >= kFelt * most) {
      felt.push_back(i);
    }
  }
  std::vector<std::size_t> chosen;
  const std::size_t wanted = std::min(felt.size(), static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < wanted; ++i) {
    chosen.push_back(felt[(2 * i + 1) * felt.size() / (2 * wanted)]);
  }
  return chosen;
}

/// The touches of a recorded session as loads: at moments evenly spread over the contact, the
/// force of the tool acts on the vertex of the body's surface that is nearest to the tool's place.
/// The session must have recorded the contact (record = true of the object), and the body must
/// stand in the file where it stood in the world.
/// @param fixed  what holds the body beside the touch
/// @throws InputError as read_session_contact(), for contacts without a force and for a touch of a
/// vertex that is held.
/// Source: Morris 2006, §5.3.2 ("acquired using a haptic simulation environment").
std::vector<NamedLoad> touches_of(const DeformBody& body, const deformable::SetupLoad& load,
                                  const deformable::LoadCase& fixed) {
  const auto file = body.setup.path_of(load.session);
  evaluation::SessionChoice choice;
  if (!load.object.empty()) {
    choice.object = load.object;
  }
  if (load.trial > 0) {
    choice.trial = load.trial;
  }
  const auto contact = evaluation::read_session_contact(record::SessionReader(file), choice);
  const auto& force = contact.recording.force;
  const auto poses = evaluation::resampled(contact.recording.pose, force.time);
  std::vector<NamedLoad> touches;
  for (const std::size_t i : moments(force, load.touches)) {
    NamedLoad touch{load, fixed, contact.simulated};
    touch.setup.name = touch.load.name = fmt::format("{} {}", load.name, touches.size() + 1);
    const std::int32_t vertex = nearest_outside(body.mesh, poses.position[i], touch.load.name);
    if (std::any_of(fixed.holds.begin(), fixed.holds.end(),
                    [&](const deformable::Hold& hold) { return hold.vertex == vertex; })) {
      throw InputError(fmt::format("load '{}': the tool touches vertex {}, which is held",
                                   touch.load.name, vertex));
    }
    // The tool acts on the object as the object on the tool, the other way round.
    touch.load.forces.push_back({vertex, Vector3d(-force.force[i])});
    touches.push_back(std::move(touch));
  }
  if (touches.empty()) {
    throw InputError(fmt::format("{}: the contact with '{}' in trial {} has no force",
                                 file.string(), contact.object, contact.trial));
  }
  return touches;
}

}  // namespace

using deformable::SetupLoad;

namespace {

/// A force on what is held moves nothing.
void check_moves(const geometry::TetMesh& mesh, const deformable::LoadCase& load) {
  const auto held = deformable::held_flags(mesh.vertices.size(), load.holds);
  const bool moves =
      std::ranges::any_of(load.holds,
                          [](const auto& hold) { return !hold.displacement.isZero(0); }) ||
      std::ranges::any_of(load.forces, [&](const auto& nodal) {
        return held[static_cast<std::size_t>(nodal.vertex)] == 0 && !nodal.force.isZero(0);
      });
  if (!moves) {
    throw InputError(fmt::format(
        "load '{}' moves no vertex, and has no force on one that is not held", load.name));
  }
}

}  // namespace

std::vector<NamedLoad> loads_of(const DeformBody& body, const std::vector<std::string>& names) {
  std::vector<std::string> allowed;
  for (const SetupLoad& load : body.setup.loads) {
    allowed.push_back(load.name);
  }
  if (allowed.empty()) {
    throw InputError(
        fmt::format("{}: there is no load; write [loads.NAME]", body.setup.file.string()));
  }
  std::vector<NamedLoad> loads;
  for (const SetupLoad& load : body.setup.loads) {
    const auto meant = [&](const std::string& name) {  // a load, or one touch of a session's
      return name == load.name || (!load.session.empty() && name.starts_with(load.name + " "));
    };
    if (!names.empty() && std::ranges::none_of(names, meant)) {
      continue;
    }
    const deformable::LoadCase fixed = deformable::load_case_of(body.setup, load, body.mesh);
    if (load.session.empty()) {
      loads.push_back({load, fixed, false});
    } else {
      const bool all = names.empty() || std::ranges::find(names, load.name) != names.end();
      for (NamedLoad& touch : touches_of(body, load, fixed)) {
        allowed.push_back(touch.load.name);
        if (all || std::ranges::find(names, touch.load.name) != names.end()) {
          loads.push_back(std::move(touch));
        }
      }
    }
  }
  for (const std::string& name : names) {
    if (std::ranges::find(allowed, name) == allowed.end()) {
      throw InputError(not_allowed("the load", fmt::format("'{}'", name), allowed));
    }
  }
  for (const NamedLoad& load : loads) {
    deformable::check_load(body.mesh, load.load);
    check_moves(body.mesh, load.load);
  }
  return loads;
}

}  // namespace haptrial::experiments
