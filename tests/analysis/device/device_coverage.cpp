#include "tests/analysis/device/device_coverage.h"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "analysis/device/certificate.h"
#include "core/base/random.h"
#include "tests/analysis/device/simulated_certificate.h"

namespace haptrial::test {
namespace {

using analysis::CertificatePart;
using analysis::Interval;
using Complex = std::complex<double>;

constexpr double kRate = 1000.0;  // [Hz]
constexpr double kPi = std::numbers::pi;

class Counts {
 public:
  void add(const std::string& figure, const Interval& interval, double truth) {
    for (CoverageCount& count : counts_) {
      if (count.figure == figure) {
        count.held += holds(interval, truth);
        ++count.of;
        return;
      }
    }
    counts_.push_back({figure, holds(interval, truth), 1});
  }
  void add(const std::string& figure, const std::optional<Interval>& interval, double truth) {
    add(figure, interval.value_or(Interval{}), truth);  // not found: not held
  }
  std::vector<CoverageCount> counts() const { return counts_; }

 private:
  static int holds(const Interval& i, double truth) { return i.low <= truth && truth <= i.high; }
  std::vector<CoverageCount> counts_;
};

/// Response of the planted motors by the two exponentials of the resonance, summed as a series.
Complex planted_response(const device::VirtualDeviceParameters& p, double frequency) {
  const double w = 2.0 * kPi * p.faults.resonance;
  const Complex root(-p.faults.resonance_damping * w,
                     w * std::sqrt(1.0 - std::pow(p.faults.resonance_damping, 2)));
  const Complex z = std::polar(1.0, 2.0 * kPi * frequency / kRate);
  // h(t) = w² / Im(root) · Im exp(root t), integrated over each held tick.
  const auto half = [&](Complex r) {
    const Complex step = std::exp(r / kRate);
    return w * w / root.imag() * (step - 1.0) / r / (z - step);
  };
  const Complex held = (half(root) - half(std::conj(root))) / Complex(0.0, 2.0);
  return p.faults.gain * held * std::polar(1.0, -2.0 * kPi * frequency * p.force_delay / kRate);
}

void add_response(const device::VirtualDeviceParameters& p,
                  const std::vector<analysis::AxisResponse>& axes, Counts& counts) {
  const double z = p.faults.resonance_damping;
  const double c = 1.0 - 2.0 * z * z;
  for (const analysis::AxisResponse& axis : axes) {
    counts.add("gain of the response", axis.gain, p.faults.gain);
    counts.add("delay", axis.delay, p.force_delay / kRate);
    counts.add("resonance", axis.resonance, p.faults.resonance);
    counts.add("damping", axis.damping, z);
    counts.add("bandwidth", axis.bandwidth,
               p.faults.resonance * std::sqrt(c + std::sqrt(c * c + 1.0)));
    double phase = 0.0;
    Complex before = 1.0;
    for (const analysis::ToneResponse& tone : axis.tones) {
      const Complex truth = planted_response(p, tone.frequency);
      phase += std::arg(truth / before);
      before = truth;
      counts.add("gain at a frequency", tone.gain, std::abs(truth));
      if (tone.frequency < 1.5 * p.faults.resonance) {  // beyond, noise turns the phase by rounds
        counts.add("phase at a frequency", tone.phase, phase);
      }
    }
  }
}

/// Faults of a part's own size, each of which may be absent but for gain, delay and friction.
FaultyPart random_faults(device::Part of, std::uint64_t seed) {
  RandomStream random(seed, "planted faults");
  FaultyPart part = faulty_part(of);
  device::MotorFaults& faults = part.electronics.faults;
  const auto sometimes = [&random](double low, double high) {
    return random.uniform() < 0.7 ? random.uniform(low, high) : 0.0;
  };
  faults.gain = random.uniform(0.7, 1.1);
  faults.dead_zone = sometimes(0.02, 0.04 * part.max_force);
  faults.resonance = sometimes(60.0, 130.0);
  faults.resonance_damping = random.uniform(0.1, 0.3);
  faults.cogging = sometimes(0.03, 0.02 * part.max_force);
  faults.cogging_period = random.uniform(0.002, 0.004);
  faults.gravity_error = sometimes(-0.1, 0.1);
  part.electronics.force_delay = 1 + static_cast<int>(random.below(4));
  part.mount.mass *= random.uniform(0.7, 1.5);
  part.mount.friction = random.uniform(0.05, 0.07 * part.max_force);
  return part;
}

/// An interval of a share to either side.
std::optional<Interval> about(std::optional<Interval> found, double share) {
  if (found) {
    found->low = (1.0 - share) * found->value;
    found->high = (1.0 + share) * found->value;
  }
  return found;
}

/// A fault that motion shows clearly; that none is shown where none is planted counts as well.
void add_clear(const std::string& figure, const std::optional<Interval>& found, double planted,
               double truth, Counts& counts) {
  if (planted == 0.0) {
    counts.add(fmt::format("no {}", figure.substr(0, figure.find(" within"))),
               Interval{0.0, found ? 1.0 : 0.0, 1.0}, 0.0);
  } else if (found) {
    counts.add(figure, found, truth);
  }
}

}  // namespace

device::VirtualDeviceParameters faulty_electronics() {
  device::VirtualDeviceParameters p;
  p.force_delay = 4;
  p.faults.gain = 0.87;
  p.faults.dead_zone = 0.15;
  p.faults.resonance = 90.0;
  p.faults.resonance_damping = 0.12;
  p.faults.cogging = 0.08;
  p.faults.cogging_period = 0.003;
  p.faults.gravity_error = -0.12;
  return p;
}

device::SensedMountParameters faulty_mount() {
  device::SensedMountParameters p;
  p.mass = 0.22;
  p.friction = 0.3;
  p.noise = 0.02;
  return p;
}

FaultyPart faulty_part(device::Part of) {
  FaultyPart part{faulty_electronics(), faulty_mount(), 4.8, {0, 1, 2}, 0.04};
  device::MotorFaults& faults = part.electronics.faults;
  if (of == device::Part::kRotation) {
    faults.gain = 0.92;
    faults.dead_zone = 0.1;
    faults.resonance = 70.0;
    faults.cogging = 0.06;
    faults.cogging_period = 0.004;
    part.electronics.force_delay = 3;
    part.mount.mass = 0.05;
    part.mount.friction = 0.2;
    part.reach = 0.02;
  } else if (of == device::Part::kGrip) {
    faults.gain = 0.8;
    faults.resonance = 120.0;
    faults.resonance_damping = 0.2;
    faults.cogging_period = 0.0025;
    part.electronics.force_delay = 2;
    part.mount.mass = 0.08;
    part.mount.friction = 0.25;
    part.max_force = 3.2;
    part.axes = {0};
    part.reach = 0.008;
  }
  return part;
}

std::vector<CoverageCount> count_coverage(const FaultyPart& part, int first, int count) {
  const analysis::Excitation excitation(kRate, part.max_force, part.axes, part.reach);
  const device::VirtualDeviceParameters& p = part.electronics;
  const device::SensedMountParameters& mount = part.mount;
  Counts counts;
  for (int seed = first; seed < first + count; ++seed) {
    const auto record =
        simulated_certificate(p, mount, excitation, static_cast<std::uint64_t>(seed),
                              {CertificatePart::kRest, CertificatePart::kGrid,
                               CertificatePart::kFrequency, CertificatePart::kMove},
                              part.reach);
    const analysis::CertificateResult result = identify_device(record, excitation);
    counts.add("noise of the sensor", result.rest.sensor, mount.noise);
    counts.add("gain", result.statics->gain, p.faults.gain);
    counts.add("dead zone", result.statics->dead_zone, p.faults.dead_zone);
    for (const analysis::DirectionForce& direction : result.statics->directions) {
      counts.add("gain in a direction", direction.gain, p.faults.gain);
      counts.add("gain in a direction", direction.opposite_gain, p.faults.gain);
      counts.add("dead zone in a direction", direction.dead_zone, p.faults.dead_zone);
    }
    add_response(p, result.response, counts);
    for (std::size_t axis = 0; axis < result.motion.size(); ++axis) {
      const analysis::AxisMotion& motion = result.motion[axis];
      counts.add("friction", motion.friction, mount.friction);
      counts.add("inertia", motion.inertia, mount.mass);
      counts.add("gravity error", motion.offset,
                 part.axes[axis] == 1 ? p.faults.gravity_error : 0.0);
      counts.add("cogging", motion.cogging, p.faults.cogging);
      counts.add("period of the cogging", motion.period, p.faults.cogging_period);
    }
  }
  return counts.counts();
}

std::vector<CoverageCount> count_free_coverage(device::Part of, int first, int count) {
  Counts counts;
  for (int seed = first; seed < first + count; ++seed) {
    const FaultyPart part = random_faults(of, static_cast<std::uint64_t>(seed));
    const analysis::Excitation excitation(kRate, part.max_force, part.axes,
                                          of == device::Part::kTip ? 0.1 : part.reach);
    const device::MotorFaults& faults = part.electronics.faults;
    const analysis::CertificateResult result = identify_device(
        simulated_certificate(part.electronics, part.mount, excitation,
                              static_cast<std::uint64_t>(seed), {CertificatePart::kFree}),
        excitation);
    for (std::size_t axis = 0; axis < result.free.size(); ++axis) {
      const analysis::FreeMotion& found = result.free[axis];
      counts.add("gain / inertia", found.mobility, faults.gain / part.mount.mass);
      counts.add("delay", found.delay, part.electronics.force_delay / kRate);
      counts.add("friction", found.friction, part.mount.friction / faults.gain);
      counts.add("dead zone", found.dead_zone, faults.dead_zone);
      counts.add("offset", found.offset,
                 part.axes[axis] == 1 ? faults.gravity_error / faults.gain : 0.0);
      add_clear("resonance", found.resonance, faults.resonance, faults.resonance, counts);
      add_clear("damping", found.damping, faults.resonance, faults.resonance_damping, counts);
      // The virtual device gives each tick the cogging of the tick's end, which no interval knows.
      add_clear("cogging within 4 %", about(found.cogging, 0.04), faults.cogging,
                faults.cogging / faults.gain, counts);
      add_clear("period within 0.5 %", about(found.period, 0.005), faults.cogging,
                faults.cogging_period, counts);
    }
  }
  return counts.counts();
}

}  // namespace haptrial::test
