#include "protocols/psychophysics/subject/answer_by_hand.h"

#include <algorithm>
#include <cmath>

#include "core/subject/perceiver/probing.h"
#include "protocols/psychophysics/definition/mark_means.h"
#include "protocols/psychophysics/definition/question.h"

namespace haptrial::protocols {
namespace {

Eigen::Vector3d place_of_mark(const Mark& mark) noexcept {
  return Eigen::Vector3f(mark.place[0], mark.place[1], mark.place[2]).cast<double>();
}

}  // namespace

int AnswerByHand::place_of(const TrialQuestion& question, int choice) noexcept {
  const auto chosen = static_cast<std::size_t>(choice);
  if (choice < 0 || chosen >= question.means.size() || question.means[chosen].touch.empty()) {
    return -1;
  }
  int place = 0;
  for (std::size_t i = 0; i < chosen; ++i) {
    place += question.means[i].touch.empty() ? 0 : 1;
  }
  return place;
}

void AnswerByHand::begin(const TrialView& view, std::size_t mark,
                         subject::ExplorationController& prober, const PointState& hand) noexcept {
  constexpr double kLeast = 0.01;  // of a place whose size is not shown [m]
  constexpr double kBeyond = 1.5;  // its radius, as far as a box reaches to its corners
  const Mark& aim = view.marks[mark];
  place_ = place_of_mark(aim);
  device_ = aim.device;
  const double radius = std::max(kLeast, kBeyond * static_cast<double>(aim.radius));
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < view.mark_count; ++i) {
    middle += place_of_mark(view.marks[i]) / view.mark_count;
  }
  // Towards the middle of all places, or the origin if this is the only one.
  Eigen::Vector3d out = middle - place_;
  out = out.norm() > 1e-6 ? out : -place_;
  out = out.norm() > 1e-6 ? out : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  away_ = place_ + 1.5 * radius * out.normalized();
  under_way_ = true;
  go(prober, hand, (hand.position - place_).norm() < radius);
}

void AnswerByHand::go(subject::ExplorationController& prober, const PointState& hand,
                      bool away) noexcept {
  going_away_ = away;
  time_ = 0.0;
  prober.begin(subject::Reach{away ? away_ : place_, kReach}, hand);
}

void AnswerByHand::tick(subject::ExplorationController& prober, const PointState& hand,
                        double dt) noexcept {
  time_ += dt;
  if (under_way_ && time_ > kReach + (going_away_ ? 0.0 : kPatience)) {
    go(prober, hand, !going_away_);
  }
}

namespace {

void reach(subject::ExplorationController& prober, double x, const PointState& hand) noexcept {
  prober.begin(subject::Reach{{x, 0.0, 0.0}, MarkByHand::kReach}, hand);
}

}  // namespace

void MarkByHand::begin(const MarkMeans& mark, double x, subject::ExplorationController& prober,
                       const PointState& hand) noexcept {
  constexpr double kNear = 0.1, kAway = 0.3;  // of the line
  x_ = x;
  time_ = 0.0;
  under_way_ = true;
  going_away_ = std::abs(hand.position.x() - x) < kNear * mark.length;
  reach(prober, going_away_ ? x - std::copysign(kAway * mark.length, x) : x, hand);
}

bool MarkByHand::tick(subject::ExplorationController& prober, const PointState& hand,
                      double dt) noexcept {
  constexpr double kHeld = 0.1;  // [s]
  time_ += dt;
  if (going_away_ && time_ > kReach) {
    going_away_ = false;
    time_ = 0.0;
    reach(prober, x_, hand);
  }
  const double pressed = time_ - kReach - kRest;
  return !going_away_ && pressed > 0.0 && pressed < kHeld;
}

}  // namespace haptrial::protocols
