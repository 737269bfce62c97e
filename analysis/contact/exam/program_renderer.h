#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "analysis/contact/exam/candidate.h"
#include "core/base/child_process.h"

namespace haptrial::evaluation {

/// Another program that renders contact. It reads lines of its standard input and answers each one
/// with a line:
///
///     body stiffness N/m friction MU rate HZ FILE     ready
///     start X Y Z                                     ready
///     tick TIME X Y Z                                 FX FY FZ
///
/// or, of a rigid tool, whose turns are unit quaternions,
///
///     body stiffness N/m friction MU rate HZ FILE     ready
///     tool turning N·m/rad FILE                       ready
///     start X Y Z QW QX QY QZ                         ready
///     tick TIME X Y Z QW QX QY QZ                     FX FY FZ TX TY TZ
///
/// with positions in metres in the frame of the body's mesh, forces on the tool in newtons and
/// torques about its origin in newton metres. A task
/// begins with "body", a path with "start", whose place is in the air; there may be several paths
/// in a task and several tasks in a run. The program ends with its input.
///
/// Waits for the program: not for a servo thread. Source: Morris 2006, §7.5.
class ProgramRenderer final : public Candidate {
 public:
  /// @param words  the program and its arguments @throws InputError where it cannot be started.
  explicit ProgramRenderer(const std::vector<std::string>& words);

  /// Begins a task. @throws InputError for an answer other than "ready", or none within a minute.
  void begin(const ContactTask& task) override;
  /// Puts the tool to a place in the air. @throws InputError as begin()
  void start(const Eigen::Isometry3d& tool) override;
  /// @throws InputError for an answer that is no three finite numbers, six of a rigid tool, or none
  /// within a minute.
  Answer tick(double time, const Eigen::Isometry3d& tool) override;

 private:
  std::string words_of(const Eigen::Isometry3d& tool) const;
  std::string ask(const std::string& line);
  void expect_ready(const std::string& line);
  [[noreturn]] void refuse(const std::string& line, const std::string& found) const;

  std::string name_;
  bool rigid_{false};
  Pipe to_, from_;
  std::unique_ptr<ChildProcess> program_;
  std::string rest_;  // that was read beyond a line
};

}  // namespace haptrial::evaluation
