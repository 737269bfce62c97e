#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>

#include "core/deformable/body/block_matrix.h"

namespace haptrial::evaluation {

/// Kinds of exam, by what is in contact.
enum class ExamKind : std::uint8_t {
  kPoint,  // a tool that is a point, on a hard body
  kRigid,  // a rigid tool with a shape of its own, without friction
  kSoft    // a body that gives way, of which the tool holds some vertices
};

/// A contact that a candidate renders, at a stiffness and with Coulomb friction. A soft body has
/// all in its file, so that a rate is left.
struct ContactTask {
  std::filesystem::path body{};   // closed mesh (.obj), in metres; a soft body (soft_body.h, .node)
  double stiffness{500.0};        // of the spring to the hand [N/m]
  double friction{0.0};           // static and dynamic alike
  double rate{1000.0};            // ticks per second [Hz]
  std::filesystem::path tool{};   // likewise a mesh, in its own frame; empty: a point
  double turning_stiffness{0.0};  // of the spring that turns a rigid tool with the hand [N·m/rad]

  bool is_rigid() const { return !tool.empty(); }
  bool is_soft() const { return body.extension() == ".node"; }
  ExamKind kind() const {
    return is_soft() ? ExamKind::kSoft : is_rigid() ? ExamKind::kRigid : ExamKind::kPoint;
  }
};

/// Force and torque on the hand, and where a soft body is.
struct Answer {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};   // [N]
  Eigen::Vector3d torque{Eigen::Vector3d::Zero()};  // about the tool's origin [N·m]
  deformable::Vectors shape{};  // displacements of the vertices [m]; empty where nobody asks
};

/// A renderer that sits the exam: a kind of the program's own, or another program. Poses are in the
/// frame of the body's mesh; those of a point have a place alone.
class Candidate {
 public:
  virtual ~Candidate() = default;
  /// Prepares the body. @throws InputError for a task that cannot be rendered
  virtual void begin(const ContactTask& task) = 0;
  /// Puts the tool to a pose in the air. After begin(); again for each path.
  virtual void start(const Eigen::Isometry3d& tool) = 0;
  /// @param time  since the start [s]  @param tool  where the hand has it
  virtual Answer tick(double time, const Eigen::Isometry3d& tool) = 0;
  /// Sets the share of a soft body's forces that acts from the next tick on.
  virtual void set_load(double /*share*/) {}
  /// @returns displacements of a soft body's vertices after the last tick [m]
  virtual deformable::Vectors shape() { return {}; }
};

}  // namespace haptrial::evaluation
