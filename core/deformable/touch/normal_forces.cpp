#include "core/deformable/touch/normal_forces.h"

#include <Eigen/Cholesky>
#include <array>

namespace haptrial::deformable {
namespace {

constexpr int kMostPivots = 60;
constexpr int kTries = 3;                // pivots of many places without progress
constexpr double kForceRounding = 1e-9;  // [N]
constexpr double kGapRounding = 1e-12;   // [m]

using Vector = PressedPlaces::Vector;
using Matrix = PressedPlaces::Matrix;

class Pivots {
 public:
  Pivots(const PressedPlaces& places, Vector& force) : places_(places), force_(force) {}

  bool run() noexcept {
    const auto n = static_cast<int>(places_.free_gap.size());
    for (int i = 0; i < n; ++i) {
      pressed_[at(i)] = force_[i] > 0.0;
    }
    int fewest = n + 1;
    int tries = kTries;
    for (int pivot = 0; pivot < kMostPivots; ++pivot) {
      solve(n);
      const int wrong = mark_wrong(n);
      if (wrong == 0) {
        return true;
      }
      if (wrong < fewest) {
        fewest = wrong;
        tries = kTries;
      } else {
        --tries;
      }
      exchange(n, tries <= 0);
    }
    force_ = force_.cwiseMax(0.0);
    return false;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  /// Forces that close the gaps of all pressed places; no force elsewhere.
  void solve(int n) noexcept {
    std::array<int, PressedPlaces::kMost> which{};
    int count = 0;
    for (int i = 0; i < n; ++i) {
      if (pressed_[at(i)]) {
        which[at(count++)] = i;
      }
    }
    Matrix part(count, count);
    Vector right(count);
    for (int i = 0; i < count; ++i) {
      right[i] = -places_.free_gap[which[at(i)]];
      for (int j = 0; j < count; ++j) {
        part(i, j) = places_.compliance(which[at(i)], which[at(j)]);
      }
    }
    force_.setZero();
    if (count > 0) {
      const Eigen::LLT<Matrix> factors(part);
      const Vector found = factors.solve(right);
      for (int i = 0; i < count; ++i) {
        force_[which[at(i)]] = found[i];
      }
    }
    gap_ = places_.free_gap;
    gap_.noalias() += places_.compliance * force_;
  }

  int mark_wrong(int n) noexcept {
    int count = 0;
    for (int i = 0; i < n; ++i) {
      const bool wrong =
          pressed_[at(i)] ? !(force_[i] >= -kForceRounding) : !(gap_[i] >= -kGapRounding);
      wrong_[at(i)] = wrong;
      count += wrong ? 1 : 0;
    }
    return count;
  }

  void exchange(int n, bool only_last) noexcept {
    for (int i = n - 1; i >= 0; --i) {
      if (wrong_[at(i)]) {
        pressed_[at(i)] = !pressed_[at(i)];
        if (only_last) {
          return;
        }
      }
    }
  }

  const PressedPlaces& places_;
  Vector& force_;
  Vector gap_;
  std::array<bool, PressedPlaces::kMost> pressed_{}, wrong_{};
};

}  // namespace

bool press(const PressedPlaces& places, PressedPlaces::Vector& force) noexcept {
  const bool ended = Pivots(places, force).run();
  force = force.cwiseMax(0.0).eval();
  return ended;
}

}  // namespace haptrial::deformable
