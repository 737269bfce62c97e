#include "core/subject/hand_cvode.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cmath>

#include "core/base/error.h"

namespace haptrial::subject {

struct CvodeHand::Solver {
  AxisDynamics yielding;
  AxisDynamics holding;
  double friction;
  double slip_speed;
  HandCommand command;
  Eigen::Vector3d motor_force{Eigen::Vector3d::Zero()};
  double time{0.0};
  bool ok{true};

  SUNContext context{nullptr};
  N_Vector y{nullptr};
  SUNMatrix matrix{nullptr};
  SUNLinearSolver linear{nullptr};
  void* cvode{nullptr};

  ~Solver() {
    CVodeFree(&cvode);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(y);
    SUNContext_Free(&context);
  }

  static int derivative(double, N_Vector state, N_Vector rate, void* self) {
    const Solver& s = *static_cast<Solver*>(self);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Map<const AxisState> x(N_VGetArrayPointer(state) + 5 * axis);
      Eigen::Map<AxisState> dx(N_VGetArrayPointer(rate) + 5 * axis);
      const bool vertical = axis == 1;
      const AxisDynamics& d = vertical && s.command.holds_posture ? s.holding : s.yielding;
      const double friction = -s.friction * std::tanh(x[1] / s.slip_speed);
      const Eigen::Vector2d input(s.motor_force[axis] + s.command.force[axis] + friction,
                                  vertical ? -s.command.press : 0.0);
      dx = d.system * x + d.input * input;
    }
    return 0;
  }
};

CvodeHand::CvodeHand(const HandParameters& parameters, double slip_speed, double tolerance,
                     const Eigen::Vector3d& start)
    : solver_(std::make_unique<Solver>()) {
  Solver& s = *solver_;
  s.yielding = axis_dynamics(parameters, true);
  s.holding = axis_dynamics(parameters, false);
  s.friction = parameters.coulomb_friction;
  s.slip_speed = slip_speed;
  bool good = SUNContext_Create(nullptr, &s.context) == 0;
  s.y = good ? N_VNew_Serial(15, s.context) : nullptr;
  s.matrix = good ? SUNDenseMatrix(15, 15, s.context) : nullptr;
  s.linear = good ? SUNLinSol_Dense(s.y, s.matrix, s.context) : nullptr;
  s.cvode = good ? CVodeCreate(CV_BDF, s.context) : nullptr;
  good = good && s.y != nullptr && s.matrix != nullptr && s.linear != nullptr && s.cvode != nullptr;
  if (good) {
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Map<AxisState>(N_VGetArrayPointer(s.y) + 5 * axis) << start[axis], 0.0, start[axis],
          0.0, 0.0;
    }
    good = CVodeInit(s.cvode, Solver::derivative, 0.0, s.y) == CV_SUCCESS &&
           CVodeSStolerances(s.cvode, tolerance, tolerance * 1e-3) == CV_SUCCESS &&
           CVodeSetUserData(s.cvode, &s) == CV_SUCCESS &&
           CVodeSetLinearSolver(s.cvode, s.linear, s.matrix) == CV_SUCCESS &&
           CVodeSetMaxNumSteps(s.cvode, 100000) == CV_SUCCESS;
  }
  if (!good) {
    throw RunError("SUNDIALS CVODE could not be set up for the hand");
  }
}

CvodeHand::~CvodeHand() = default;

void CvodeHand::command(const HandCommand& command) noexcept { solver_->command = command; }

PointState CvodeHand::step(const Eigen::Vector3d& motor_force, double dt) noexcept {
  Solver& s = *solver_;
  s.motor_force = motor_force;
  const double end = s.time + dt;
  // The inputs jump at every step: the history of the last one does not hold any more.
  s.ok = s.ok && CVodeReInit(s.cvode, s.time, s.y) == CV_SUCCESS &&
         CVodeSetStopTime(s.cvode, end) == CV_SUCCESS &&
         CVode(s.cvode, end, s.y, &s.time, CV_NORMAL) >= 0;
  return state();
}

PointState CvodeHand::state() const noexcept {
  const double* y = N_VGetArrayPointer(solver_->y);
  return {{y[0], y[5], y[10]}, {y[1], y[6], y[11]}};
}

bool CvodeHand::ok() const noexcept { return solver_->ok; }

}  // namespace haptrial::subject
