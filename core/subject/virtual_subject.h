#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/stimulus/observer.h"
#include "core/stimulus/presentation.h"
#include "core/subject/force_memory.h"
#include "core/subject/hand_model.h"
#include "core/subject/hand_parameters.h"
#include "core/subject/noise.h"
#include "core/subject/pacer.h"
#include "core/subject/path_learner.h"
#include "core/subject/perception.h"

namespace haptrial::subject {

/// An instant of a training pass that a participant went through in an earlier session.
struct LessonMoment {
  stimulus::Presentation view;
  double force{0.0};  // that was to be opposed or produced [N]
};

/// Training of a block in earlier sessions.
struct Lesson {
  std::int32_t block{0};
  int exposures{0};
  int sessions_ago{0};                // of the latest
  std::vector<LessonMoment> moments;  // over a pass, in their order
};

/// A simulated participant: sees what the screen shows, feels what the device applies, remembers
/// and acts through a hand. Knows the instruction, not the condition and not the target.
/// docs/algorithms/virtual-subject.md says what is assumed and what follows.
class VirtualSubject final : public stimulus::Observer {
 public:
  /// @param hand  outlives the subject.
  /// @param step  servo period > 0 [s]
  /// @param pace  how the subject moves where it sets its own pace; without, it waits there
  /// @param path  how it learns paths; without, it learns none
  VirtualSubject(const SubjectParameters& person, const HandParameters& hand_parameters,
                 HandModel& hand, std::uint64_t seed, double step,
                 const std::optional<PaceParameters>& pace = std::nullopt,
                 const std::optional<PathParameters>& path = std::nullopt);

  /// Before the first pass. A block of a lesson begins with what its exposures left: they are
  /// perceived and fade as in a session, and each session since counts as one more pass.
  void remember(std::vector<Lesson> lessons) { lessons_ = std::move(lessons); }

  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override;

 private:
  static constexpr int kDelayLine = 16384;  // ticks: 0.8 s at the highest rate, 20 kHz

  struct Sensed {
    double height{0.0};                             // target bar [N of its scale]
    double mismatch{0.0};                           // target bar minus applied bar [N of its scale]
    double felt{0.0};                               // [N]
    bool saturated{false};                          // the square is seen, or the handle gives way
    double progress{0.0};                           // along the path
    Eigen::Vector3d hand{Eigen::Vector3d::Zero()};  // where it is [m]
  };

  void begin_pass(const stimulus::Presentation& seen) noexcept;
  void begin_block(std::int32_t block) noexcept;
  void go_through(const Lesson& lesson) noexcept;
  void forget() noexcept;
  void gather(const stimulus::Presentation& seen, const Sensed& now) noexcept;
  void end_pass() noexcept;
  double wrong_in_time(double progress) const noexcept;
  double intended_press(const stimulus::Presentation& seen, double dt) noexcept;
  double match_bars(double dt) noexcept;
  double oppose() const noexcept;
  double recall(const stimulus::Presentation& seen) const noexcept;
  double hold_back(double press, double dt) noexcept;
  Eigen::Vector3d move_on(const stimulus::Presentation& seen) noexcept;
  const Sensed& delayed(double delay) const noexcept;

  SubjectParameters person_;
  HandModel& hand_;
  double step_;
  double muscle_lag_;  // a recalled force is commanded this much ahead [s]
  RandomStream random_;
  MotorNoise motor_;
  std::optional<Pacer> pacer_;
  std::optional<PathLearner> path_;
  BarCalibration bar_;
  ForceMemory memory_;
  Exposure exposure_;
  std::vector<Lesson> lessons_;  // of earlier sessions

  std::array<Sensed, kDelayLine> past_{};
  std::uint32_t now_{0};
  std::array<double, ForceProfile::kKnots> warp_{};  // of recall [s]
  double produced_scale_{1.0};
  double correction_{0.0};  // of the press, learnt from the bars [N]
  double boldness_{1.0};    // share of the intended press that the hand dares
  double pass_duration_{1.0};
  std::int32_t block_{0};
  bool in_run_{false};
};

}  // namespace haptrial::subject
