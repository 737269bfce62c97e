#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/contact/exam/candidate.h"
#include "core/base/child_process.h"

namespace haptrial::evaluation {

/// Another program that renders contact, or models soft bodies. It reads lines of its standard
/// input and answers each one with a line:
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
/// or, of a soft body (soft_body.h),
///
///     body soft rate HZ FILE                          ready
///     start X Y Z                                     ready
///     tick TIME X Y Z LOAD                            FX FY FZ
///     shape                                           UX UY UZ of each vertex, on one line
///
/// with positions in metres in the frame of the body's mesh, forces on the tool in newtons,
/// torques about its origin in newton metres and displacements in metres. A task
/// begins with "body", a path with "start", whose place is in the air; there may be several paths
/// in a task and several tasks in a run. The program ends with its input.
///
/// Waits for the program: not for a servo thread. Source: Morris 2006, §7.5.
class ProgramRenderer final : public Candidate {
 public:
  /// @param words  the program and its arguments
  /// @param go_on  asked at every line and ten times a second while one is waited for; on false all
  /// functions throw geometry::Cancelled. Empty: never asked
  /// @throws InputError where it cannot be started.
  explicit ProgramRenderer(const std::vector<std::string>& words, std::function<bool()> go_on = {});

  /// Begins a task. @throws InputError for an answer other than "ready", or none within a minute.
  void begin(const ContactTask& task) override;
  /// Puts the tool to a place in the air. @throws InputError as begin()
  void start(const Eigen::Isometry3d& tool) override;
  /// @throws InputError for an answer that is not three finite numbers, six of a rigid tool, or
  /// none within a minute.
  Answer tick(double time, const Eigen::Isometry3d& tool) override;
  void set_load(double share) override { load_ = share; }
  /// @throws InputError as tick(), for three numbers of each vertex
  deformable::Vectors shape() override;

 private:
  std::string words_of(const Eigen::Isometry3d& tool) const;
  std::string ask(const std::string& line, std::size_t longest);
  bool read_more();
  void check_cancelled() const;
  void expect_ready(const std::string& line);
  std::vector<double> ask_numbers(const std::string& line, std::size_t count);

  std::string name_;
  std::function<bool()> go_on_;
  ExamKind kind_{ExamKind::kPoint};
  double load_{0.0};         // of a soft body
  std::size_t vertices_{0};  // likewise
  Pipe to_, from_;
  std::unique_ptr<ChildProcess> program_;
  std::string rest_;  // that was read beyond a line
};

}  // namespace haptrial::evaluation
