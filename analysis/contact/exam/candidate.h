#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>

namespace haptrial::evaluation {

/// A contact that a candidate renders, at a stiffness and with Coulomb friction.
struct ContactTask {
  std::filesystem::path body{};  // closed mesh (.obj), in metres
  double stiffness{500.0};       // [N/m]
  double friction{0.0};          // static and dynamic alike
  double rate{1000.0};           // ticks per second [Hz]
};

/// A renderer that sits the exam: a kind of the program's own, or another program. Positions are
/// in the frame of the mesh [m], forces act on the tool, a point [N].
class Candidate {
 public:
  virtual ~Candidate() = default;
  /// Prepares the body. @throws InputError for one that cannot be rendered
  virtual void begin(const ContactTask& task) = 0;
  /// Puts the tool to a place in the air. After begin(); again for each path.
  virtual void start(const Eigen::Vector3d& tool) = 0;
  /// @param time  since the start [s]
  virtual Eigen::Vector3d tick(double time, const Eigen::Vector3d& tool) = 0;
};

/// A kind of renderer (core/contact/renderer_kinds.h) whose tool may be a point. One without
/// friction renders every task without.
/// @param word  as a command line has it: "distance-field"
/// @throws InputError for another word.
std::unique_ptr<Candidate> own_candidate(const std::string& word);

}  // namespace haptrial::evaluation
