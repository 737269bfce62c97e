#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/tutoring/tutoring_law.h"

namespace haptrial::protocols {

/// Which recorded run leads the hand: "FILE", "FILE:TRIAL" or "FILE:TRIAL@SECONDS".
struct TutorChoice {
  std::filesystem::path file;
  std::optional<int> trial;  // from 1; none: the first that was completed
  double from{0.0};          // where in the run it begins [s]
};
/// @throws InputError for another form
TutorChoice read_tutor_choice(const std::string& text);

/// A person's motion in one recorded run: the ticks of its stage `run`.
struct ModelMotion {
  double rate{1000.0};  // [Hz]
  int trial{0};
  std::string subject;                   // who did it
  std::string definition;                // whole text of the definition that it was done by
  std::string definition_name;           // its file
  std::vector<tutoring::Partner> ticks;  // not empty
  double duration() const noexcept { return static_cast<double>(ticks.size() - 1) / rate; }
};

/// @throws InputError where the file is no session, has no completed run of the trial, or the run
///         is over before choice.from
ModelMotion read_model(const TutorChoice& choice);

/// Plays a motion: where it is at each tick of another loop. Servo thread after the constructor.
class Playback {
 public:
  /// @param motion  outlives it  @param speed  of the original, 0 < speed <= 1
  Playback(const ModelMotion& motion, double speed, double from) noexcept
      : motion_(&motion), speed_(speed), time_(from) {}

  /// State between two recorded ticks: places and forces on the line between them; a slower
  /// playback has smaller velocities and the same forces. After its end it stands with the last
  /// force.
  tutoring::Partner now() const noexcept;
  void step(double dt) noexcept;
  /// Whether it stands with the force of its place. It comes to rest, and up to its speed again,
  /// over kTimeToRest, so that a damper takes no step.
  void wait(bool waits) noexcept { waits_ = waits; }
  bool over() const noexcept { return time_ >= motion_->duration(); }
  double time() const noexcept { return time_; }  // in the motion [s]

 private:
  const ModelMotion* motion_;
  double speed_;
  double time_;
  tutoring::Handover pace_{tutoring::kTimeToRest, 1.0};  // share of the speed
  bool waits_{false};
};

}  // namespace haptrial::protocols
