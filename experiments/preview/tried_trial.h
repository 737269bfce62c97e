#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "core/base/point_state.h"
#include "core/device/mouse.h"
#include "experiments/preview/preview.h"
#include "experiments/preview/space_objects.h"
#include "protocols/interface/pass.h"
#include "protocols/psychophysics/studied_definition.h"

namespace haptrial::experiments {

/// A trial that a pointer tries before anybody runs it: the pointer stands for the hand, as in a
/// session with the device "mouse". Time is simulated and goes on with each tick.
class TriedTrial {
 public:
  struct Moment {
    PointState hand;                                 // in W [m], [m/s]
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the hand, in W [N]
  };
  virtual ~TriedTrial() = default;

  virtual double rate() const = 0;                      // of the servo loop [Hz]
  virtual Eigen::Vector3d start() const = 0;            // of the hand, in W [m]
  virtual double reach() const = 0;                     // from the origin of W [m]
  virtual std::vector<std::string> stages() const = 0;  // their names
  virtual std::vector<SpaceObject> objects() const = 0;

  /// Begins a stage. @param stage  from 0, of stages()
  virtual void choose(std::size_t stage) = 0;
  /// One tick of the servo loop. @param pointer  in W [m]
  virtual Moment tick(const Eigen::Vector3d& pointer) = 0;
  /// Says what went on in the last tick, in one line.
  virtual std::string now() const = 0;
};

/// The device "mouse" as the hand of a page, which moves it along all three axes.
device::MouseDevice page_hand(const protocols::Definition& definition,
                              const Eigen::Vector3d& start);

/// The stages of a trial that a definition states whole, by the mouse device and the scenes of
/// sessions. @param definition  outlives it  @throws InputError for a trial beyond the session
std::shared_ptr<TriedTrial> tried_scenes(const protocols::StudiedDefinition& definition,
                                         const PreviewRequest& request);

/// Tries a trial by lines until the input ends. The first line of the output is a JSON object with
/// rate, start, reach, stages and objects. Then each line of the input is answered by one:
///
///     stage N      begins the stage N, from 1            -> "stage N"
///     to T X Y Z   the pointer is at X Y Z [m] until T [s] -> "T X Y Z FX FY FZ NOW", hand, force,
///                  and what goes on in words
///
/// The loop ticks at its own rate up to T; T that lies 0.5 s or more ahead counts as 0.5 s ahead.
/// Any other line is answered by "? " and a sentence that says what is allowed.
void try_lines(TriedTrial& trial, std::istream& in, std::ostream& out);

/// A trial of passes under a pointer: the pass of a session, driven by the device "mouse". When a
/// pass is over, nothing is felt until another begins.
class TriedPass : public TriedTrial {
 public:
  double rate() const final { return rate_; }
  Eigen::Vector3d start() const final { return start_; }
  double reach() const final { return mouse_.info().workspace_radius; }
  Moment tick(const Eigen::Vector3d& pointer) final;

 protected:
  /// @param definition  outlives the trial  @param start  of the hand, in W [m]
  TriedPass(const protocols::Definition& definition, const Eigen::Vector3d& start);
  void begin(std::unique_ptr<protocols::Pass> pass);
  /// Holds buttons of the device from the next tick on. @param buttons  a bit each
  void hold(std::uint32_t buttons) noexcept { buttons_ = buttons; }
  bool is_over() const noexcept { return pass_->state() != protocols::PassState::kRunning; }
  /// Output of the last tick.
  const protocols::PassOutput& output() const noexcept { return output_; }
  /// Called before each tick, such as for buttons that go down and up again.
  virtual void before_tick() {}

 private:
  double rate_;
  Eigen::Vector3d start_;
  device::MouseDevice mouse_;
  std::unique_ptr<protocols::Pass> pass_;
  std::uint32_t buttons_{0};
  protocols::PassOutput output_;
};

}  // namespace haptrial::experiments
