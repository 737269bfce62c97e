// Rotations and grips of every inertia at the limits of torque and grip fields: seconds in trains
// of turns, and what the envelope ends. A whole factorial; the table of
// docs/algorithms/every-hand.md.
//
//     bench_every_part

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/control/loop_margin.h"
#include "core/device/handle_part.h"
#include "protocols/interface/device_set.h"
#include "tests/protocols/interface/turning_handle.h"
#include "tests/support/swings.h"

namespace {

using namespace haptrial;
using device::Part;
using Eigen::Vector3d;

constexpr double kBare[] = {0.01, 0.05, 0.3};                          // at the fingers [kg]
constexpr double kHands[] = {0.0, 0.05, 0.3, 0.8, 2.0};                // [kg]
constexpr double kStiffness[] = {0.0, 500.0, 1000.0, 2000.0, 4000.0};  // [N/m]
constexpr double kDamping[] = {0.0, 5.0, 30.0, 100.0, 300.0};          // [N·s/m]
constexpr double kLimits[] = {4.0, 8.0};                               // of a field [N]
constexpr double kSeconds = 3.0;
constexpr double kLetsGo = 1.5;  // [s]

struct Timing {
  double rate;  // [Hz]
  int late;     // [ticks]
};
constexpr Timing kTimings[] = {{1000.0, 1}, {500.0, 3}};

struct Field {
  double stiffness, damping, limit;
  bool wall;
};

struct Cell {
  Part part;
  Timing timing;
  double bare, hand;
  bool released;
  Field field;
};

struct Outcome {
  double train;  // longest [s]
  device::Fault fault;
};

control::HandleLoop loop_of(const Timing& timing, double bare) {
  return {bare, timing.rate, std::max(2, static_cast<int>(0.008 * timing.rate)), timing.late};
}

/// Whether `validate` refuses it: no fingers carry it.
bool is_refused(const Field& field, const control::HandleLoop& loop) {
  return control::lightest_calm_hand({field.stiffness, field.damping}, loop) >
         control::kHeaviestFingers;
}

Vector3d force_of(const Field& field, const device::DeviceReading& reading, int axis) {
  const double x = reading.tool.position[axis], v = reading.tool.velocity[axis];
  Vector3d force = Vector3d::Zero();
  if (!field.wall || x > 0.0) {
    force[axis] = std::clamp(-reading.shares.stiffness * field.stiffness * x -
                                 reading.shares.damping * field.damping * v,
                             -field.limit, field.limit);
  }
  return force;
}

Outcome outcome_of(const Cell& cell) {
  const control::HandleLoop loop = loop_of(cell.timing, cell.bare);
  const double tick = 1.0 / cell.timing.rate;
  test::TurningHandle handle(cell.bare + cell.hand, cell.bare + cell.hand,
                             {tick, cell.timing.late, loop.velocity_window, 1e-5});
  handle.friction = 0.05;
  handle.hand = control::held_by_hand(cell.hand);
  handle.place(0.002);
  device::EnvelopeLimits limits;
  limits.max_force = 8.0;
  protocols::DeviceSet set(
      {{&handle, limits},
       {&handle, limits, cell.part, cell.part == Part::kGrip ? 1.0 : test::kFingers, cell.bare}},
      loop);
  const int axis = cell.part == Part::kRotation ? 1 : 0;
  std::vector<double> forces;
  for (int i = 0; i < kSeconds / tick; ++i) {
    const double t = i * tick;
    const double press = std::min(0.6 * cell.field.limit, 10.0 * cell.hand);
    if (cell.released && t >= kLetsGo) {
      handle.let_go(cell.bare);
    } else {
      handle.hand_at_rotation = handle.hand_at_grip = press * std::clamp(5.0 * (t - 0.3), 0.0, 1.0);
    }
    set.read({}, tick);
    protocols::Drive drive;
    drive.force = force_of(cell.field, set.readings()[1], axis);
    set.limit(protocols::PassOutput{}, {&drive, 1}, tick);
    set.write();
    forces.push_back(axis == 1 ? handle.given.torque.y() / test::kFingers : handle.given.grip);
  }
  return {test::longest_train(forces, cell.timing.rate), set.fault()};
}

struct Sum {
  int runs{0}, refused{0}, trains{0}, oscillations{0}, others{0};
  double longest{0.0};
};

void say(const Cell& cell, const Outcome& outcome) {
  fmt::print("  {} {:.0f} Hz, bare {} kg, hand {} kg{}, {}{} N/m, {} N·s/m, {} N: {:.2f} s, {}\n",
             device::part_word(cell.part), cell.timing.rate, cell.bare, cell.hand,
             cell.released ? " lets go" : "", cell.field.wall ? "wall " : "", cell.field.stiffness,
             cell.field.damping, cell.field.limit, outcome.train, device::describe(outcome.fault));
}

void add(const Cell& cell, Sum& sum) {
  const Outcome outcome = outcome_of(cell);
  ++sum.runs;
  sum.longest = std::max(sum.longest, outcome.train);
  sum.trains += outcome.train > 0.2;
  sum.oscillations += outcome.fault == device::Fault::kOscillation;
  sum.others +=
      outcome.fault != device::Fault::kNone && outcome.fault != device::Fault::kOscillation;
  if (outcome.train > 0.2 || outcome.fault == device::Fault::kOscillation) {
    say(cell, outcome);
  }
}

void add_hands(Part part, const Timing& timing, double bare, const Field& field, Sum& sum) {
  for (const double hand : kHands) {
    add({part, timing, bare, hand, false, field}, sum);
    if (hand > 0.0) {
      add({part, timing, bare, hand, true, field}, sum);
    }
  }
}

Sum sum_of(Part part, const Timing& timing) {
  Sum sum;
  for (const double bare : kBare) {
    for (const double stiffness : kStiffness) {
      for (const double damping : kDamping) {
        for (const double limit : kLimits) {
          const Field spring{stiffness, damping, limit, false};
          if (stiffness + damping == 0.0) {
            continue;
          }
          const bool refused = is_refused(spring, loop_of(timing, bare));
          for (const bool wall : {false, true}) {
            if (refused) {
              ++sum.refused;
            } else {
              add_hands(part, timing, bare, {stiffness, damping, limit, wall}, sum);
            }
          }
        }
      }
    }
  }
  return sum;
}

}  // namespace

int main() {
  for (const Part part : {Part::kRotation, Part::kGrip}) {
    for (const Timing& timing : kTimings) {
      const Sum sum = sum_of(part, timing);
      fmt::print(
          "{} at {:.0f} Hz, {} late: {} runs, {} fields refused; longest train {:.3f} s, {} above "
          "0.2 s; {} ended as oscillation, {} otherwise\n",
          device::part_word(part), timing.rate, control::ticks_in_words(timing.late), sum.runs,
          sum.refused, sum.longest, sum.trains, sum.oscillations, sum.others);
    }
  }
  return 0;
}
