#include "core/subject/path_learner.h"

#include <algorithm>

#include "core/subject/noise.h"
#include "core/subject/population_schema.h"

namespace haptrial::subject {
namespace {

constexpr double kReach = 150.0;      // of the arm towards the remembered place [N/m]
constexpr double kMostReach = 8.0;    // [N]
constexpr double kStartShare = 0.1;   // of the pass, over which the known start fades into memory
constexpr double kAhead = 0.01;       // of the pass, over which the speed is remembered
constexpr double kLeastNoise = 1e-5;  // two senses without noise count alike [m]
constexpr int kAxes[] = {0, 2};       // of W

}  // namespace

const Schema<Population<PathParameters>>& path_memory_schema() {
  using P = PathParameters;
  constexpr Bounds kNoise{0.0, 0.1};
  static const auto schema = make_population_schema<P>(
      "path ", true,
      {{"visual_noise", &P::visual_noise, kNoise, "m",
        "Standard deviation of a remembered place of the path that was seen"},
       {"haptic_noise", &P::haptic_noise, kNoise, "m",
        "Standard deviation of a remembered place of the path to which the hand was led"},
       {"forgetting", &P::forgetting, kNoise, "m", "Drift of the remembered path between passes"},
       {"correlation",
        &P::correlation,
        {0.05, 60.0},
        "s",
        "Time over which errors of the remembered path are alike"}});
  return schema;
}

PathLearner::PathLearner(const PathParameters& person, const HandParameters& hand,
                         RandomStream random) noexcept
    : person_(person), drag_(hand.damping + hand.stiffness * hand.posture_time), random_(random) {}

void PathLearner::begin(double duration, bool another) noexcept {
  duration_ = duration;
  for (ForceMemory& axis : memory_) {
    if (another) {
      axis.clear();
    }
    axis.drift(person_.forgetting, person_.correlation / duration_, random_);
  }
  sums_ = {};
  counts_ = {};
  seen_ = felt_ = begun_ = false;
}

void PathLearner::take(double progress, const Eigen::Vector3d& place, bool seen,
                       bool felt) noexcept {
  const int knot = std::clamp(static_cast<int>(progress * kKnots), 0, kKnots - 1);
  for (std::size_t axis = 0; axis < memory_.size(); ++axis) {
    sums_[axis][knot] += place[kAxes[axis]];
  }
  ++counts_[knot];
  seen_ = seen_ || seen;
  felt_ = felt_ || felt;
}

void PathLearner::end() noexcept {
  if (!seen_ && !felt_) {
    return;
  }
  learn(0);
  learn(1);
  seen_ = felt_ = false;
}

void PathLearner::learn(int axis) noexcept {
  SmoothNoise seen(1.0 / kKnots, person_.correlation / duration_);
  SmoothNoise felt(1.0 / kKnots, person_.correlation / duration_);
  seen.restart(random_);
  felt.restart(random_);
  const auto weight = [](bool has, double noise) {
    const double spread = std::max(noise, kLeastNoise);
    return has ? 1.0 / (spread * spread) : 0.0;
  };
  const double eye = weight(seen_, person_.visual_noise);
  const double hand = weight(felt_, person_.haptic_noise);
  ForceProfile exposure;
  double place = 0.0;  // a knot without a tick is where the one before it is
  for (int j = 0; j < kKnots; ++j) {
    place = counts_[j] > 0 ? sums_[static_cast<std::size_t>(axis)][j] / counts_[j] : place;
    const double wrong = (eye * person_.visual_noise * seen.next(random_) +
                          hand * person_.haptic_noise * felt.next(random_)) /
                         (eye + hand);
    exposure.force[j] = place + wrong;
    exposure.variance[j] = 1.0 / (eye + hand);
  }
  memory_[static_cast<std::size_t>(axis)].learn(exposure);
}

Eigen::Vector3d PathLearner::remembered(double progress) const noexcept {
  return {memory_[0].at(progress), 0.0, memory_[1].at(progress)};
}

Eigen::Vector3d PathLearner::drive(double progress, const Eigen::Vector3d& hand) noexcept {
  if (memory_[0].empty()) {
    return Eigen::Vector3d::Zero();
  }
  if (!begun_) {  // the hand was brought to the start, which nobody has to remember
    offset_ = hand - remembered(0.0);
    offset_.y() = 0.0;
    begun_ = true;
  }
  const Eigen::Vector3d here = remembered(progress);
  const double left = std::max(0.0, 1.0 - progress / kStartShare);
  Eigen::Vector3d stretch = here + left * offset_ - hand;
  stretch.y() = 0.0;
  const Eigen::Vector3d speed = (remembered(progress + kAhead) - here) / (kAhead * duration_);
  const Eigen::Vector3d force = kReach * stretch + drag_ * speed;
  const double size = force.norm();
  return size > kMostReach ? Eigen::Vector3d(force * (kMostReach / size)) : force;
}

}  // namespace haptrial::subject
