#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <string>

namespace haptrial::evaluation {

/// A contact that a candidate renders, at a stiffness and with Coulomb friction. The tool is a
/// point, or rigid and of a shape of its own; then there is no friction.
struct ContactTask {
  std::filesystem::path body{};   // closed mesh (.obj), in metres
  double stiffness{500.0};        // of the spring to the hand [N/m]
  double friction{0.0};           // static and dynamic alike
  double rate{1000.0};            // ticks per second [Hz]
  std::filesystem::path tool{};   // likewise a mesh, in its own frame; empty: a point
  double turning_stiffness{0.0};  // of the spring that turns a rigid tool with the hand [N·m/rad]

  bool is_rigid() const { return !tool.empty(); }
};

/// Force and torque on the hand.
struct Answer {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};   // [N]
  Eigen::Vector3d torque{Eigen::Vector3d::Zero()};  // about the tool's origin [N·m]
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
};

/// A kind of renderer (core/contact/renderer_kinds.h) whose tool may be a point; one without
/// friction renders every task without. Or "rigid-tool" (core/contact/rigid_tool.h), for exams with
/// one. @param word  as a command line has it: "distance-field"
/// @throws InputError for another word.
std::unique_ptr<Candidate> own_candidate(const std::string& word);

}  // namespace haptrial::evaluation
