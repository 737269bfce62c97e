#include "core/deformable/body/reference_motion.h"

#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <Eigen/Core>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <exception>

#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

/// The state is the displacement and the velocity of the free vertices, one after the other.
class Integrator {
 public:
  Integrator(const MotionProblem& problem, double first_time, const MotionAccuracy& accuracy)
      : problem_(problem), displacement_(problem.start), force_(problem.start.size()) {
    for (std::size_t v = 0; v < problem.held.size(); ++v) {
      if (problem.held[v] == 0) {
        free_.push_back(v);
      }
    }
    set_up(first_time, accuracy);
  }
  ~Integrator() {
    CVodeFree(&cvode_);
    SUNNonlinSolFree(iteration_);
    N_VDestroy(tolerance_);
    N_VDestroy(state_);
    SUNContext_Free(&context_);
  }
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  const Vectors& displacement_at(double time) {
    double reached = 0.0;
    const int flag = CVode(cvode_, time, state_, &reached, CV_NORMAL);
    if (failure_) {
      std::rethrow_exception(failure_);
    }
    if (flag < 0) {
      throw InputError(fmt::format(
          "the motion cannot be followed beyond {:.6g} s (CVODE: {}); lower the load or the "
          "tolerance",
          reached, flag));
    }
    read(state_);
    return displacement_;
  }

 private:
  /// Failures become sentences of ours.
  static void stay_silent(int, const char*, const char*, char*, void*) {}

  void set_up(double first_time, const MotionAccuracy& accuracy) {
    constexpr double kLeastStep = 1e-10;  // of the first time
    const auto size = static_cast<sunindextype>(6 * free_.size());
    bool good = SUNContext_Create(nullptr, &context_) == 0;
    state_ = good ? N_VNew_Serial(size, context_) : nullptr;
    tolerance_ = good ? N_VNew_Serial(size, context_) : nullptr;
    good = good && state_ != nullptr && tolerance_ != nullptr;
    if (good) {
      begin(first_time, accuracy);
      iteration_ = SUNNonlinSol_FixedPoint(state_, 0, context_);
      cvode_ = CVodeCreate(CV_ADAMS, context_);
      good = iteration_ != nullptr && cvode_ != nullptr &&
             CVodeInit(cvode_, rate, 0.0, state_) == CV_SUCCESS &&
             CVodeSVtolerances(cvode_, accuracy.relative, tolerance_) == CV_SUCCESS &&
             CVodeSetUserData(cvode_, this) == CV_SUCCESS &&
             CVodeSetNonlinearSolver(cvode_, iteration_) == CV_SUCCESS &&
             CVodeSetErrHandlerFn(cvode_, stay_silent, nullptr) == CV_SUCCESS &&
             CVodeSetMinStep(cvode_, kLeastStep * first_time) == CV_SUCCESS &&
             CVodeSetMaxNumSteps(cvode_, -1) == CV_SUCCESS;
    }
    if (!good) {
      throw RunError("SUNDIALS CVODE could not be set up for a body");
    }
  }

  void begin(double first_time, const MotionAccuracy& accuracy) {
    N_VConst(0.0, state_);
    const double least = accuracy.relative * accuracy.length;
    double* const state = N_VGetArrayPointer(state_);
    double* const tolerance = N_VGetArrayPointer(tolerance_);
    const std::size_t half = 3 * free_.size();
    for (std::size_t i = 0; i < half; ++i) {
      state[i] = problem_.start[free_[i / 3]][static_cast<Eigen::Index>(i % 3)];
      tolerance[i] = least;
      tolerance[half + i] = least / first_time;
    }
  }

  void read(N_Vector state) {
    const double* const x = N_VGetArrayPointer(state);
    for (std::size_t i = 0; i < free_.size(); ++i) {
      displacement_[free_[i]] = Eigen::Map<const Vector3d>(x + 3 * i);
    }
  }

  static int rate(double, N_Vector state, N_Vector rate, void* self) noexcept {
    constexpr int kSmallerStep = 1, kStop = -1;
    auto& s = *static_cast<Integrator*>(self);
    try {
      s.read(state);
      if (!s.problem_.elastic(s.displacement_, s.force_)) {
        return kSmallerStep;
      }
    } catch (...) {
      s.failure_ = std::current_exception();
      return kStop;
    }
    const std::size_t half = 3 * s.free_.size();
    const double* const velocity = N_VGetArrayPointer(state) + half;
    double* const change = N_VGetArrayPointer(rate);
    for (std::size_t i = 0; i < s.free_.size(); ++i) {
      const std::size_t v = s.free_[i];
      const Eigen::Map<const Vector3d> speed(velocity + 3 * i);
      Eigen::Map<Vector3d>(change + 3 * i) = speed;
      Eigen::Map<Vector3d>(change + half + 3 * i) =
          (s.problem_.load[v] + s.force_[v] - s.problem_.drag[v] * speed) / s.problem_.masses[v];
    }
    return 0;
  }

  const MotionProblem& problem_;
  std::vector<std::size_t> free_;  // vertices
  Vectors displacement_, force_;
  std::exception_ptr failure_;
  SUNContext context_{nullptr};
  N_Vector state_{nullptr};
  N_Vector tolerance_{nullptr};
  SUNNonlinearSolver iteration_{nullptr};
  void* cvode_{nullptr};
};

}  // namespace

std::vector<Vectors> reference_motion(const MotionProblem& problem, std::span<const double> times,
                                      const MotionAccuracy& accuracy,
                                      const std::function<void(double)>& reached) {
  Integrator integrator(problem, times.front(), accuracy);
  std::vector<Vectors> motion;
  for (const double time : times) {
    motion.push_back(integrator.displacement_at(time));
    if (reached) {
      reached(time);
    }
  }
  return motion;
}

double motion_distance(std::span<const Vectors> a, std::span<const Vectors> b) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t v = 0; v < a[i].size(); ++v) {
      sum += (a[i][v] - b[i][v]).squaredNorm();
      count += 1.0;
    }
  }
  return std::sqrt(sum / count);
}

double fitted_damping(std::span<const Vectors> reference, double low, double high,
                      const std::function<std::vector<Vectors>(double damping)>& motion_at) {
  constexpr int kBits = 14;  // 1 in 10^4
  const auto distance = [&](double logarithm) {
    return motion_distance(motion_at(std::exp(logarithm)), reference);
  };
  const auto [best, least] =
      boost::math::tools::brent_find_minima(distance, std::log(low), std::log(high), kBits);
  return std::exp(best);
}

}  // namespace haptrial::deformable
