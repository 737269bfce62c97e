#pragma once

#include "core/base/random.h"

namespace haptrial::nerve {

/// Effect of a tool on a nerve at one tick.
struct Exposure {
  double distance{1.0};  // from the tool's surface to the nerve [m]; 0 or below: contact
  double force{0.0};     // of the tool on the bone [N]
  double speed{0.0};     // of the tool's tip [m/s]
  double power{0.0};     // that drilling turns into heat >= 0 [W]
  bool drilling{false};  // the burr turns
  bool suction{false};
};

/// How a nerve answers. The figures are chosen, not measured on people: a model to train with, no
/// clinical claim.
struct ExposureParameters {
  double reach{0.002};       // over which the rate of bursts falls to 1/e [m]
  double bursts{1.0};        // a second, right beside the nerve, without force or speed [1/s]
  double per_force{1.0};     // more of them for each newton [1/N]
  double per_speed{20.0};    // more of them for each [m/s]
  double heat_reach{0.004};  // over which heat falls to 1/e [m]
  double warming{1.0};       // for each watt beside the nerve [K/s/W]
  double cooling{8.0};       // time in which a third of the warmth is left [s]
  double harmless{4.0};      // warmth without trains [K]
  double trains{0.2};        // a second for each kelvin above [1/s/K]
};

/// Events of a nerve at one tick.
struct NerveEvents {
  bool burst{false};   // a short discharge begins
  bool train{false};   // a long regular one begins
  double severity{0};  // of it, 0 to 1: how strong and how long
};

/// The nerve's side of a drilling: discharges come at random, at rates that follow the exposure;
/// heat gathers and goes (a single store, no conduction through bone); contact always discharges,
/// and with force by a train. Source: Morris 2006, §3.4.2, which names no law.
/// Servo thread: no allocation, lock, I/O or throw.
class IrritatedNerve {
 public:
  IrritatedNerve(const ExposureParameters& parameters, std::uint64_t seed, std::string_view name)
      : p_(parameters), random_(seed, name) {}

  NerveEvents step(const Exposure& exposure, double dt) noexcept;
  double warmth() const noexcept { return warmth_; }  // above the body's [K]

 private:
  ExposureParameters p_;
  RandomStream random_;
  double warmth_{0.0};
  bool touched_{false};
};

}  // namespace haptrial::nerve
