// A handle that is let go in the middle of a pass, with and without the guard, and what guarding
// and watching cost on a tick. bench_every_hand [FILE]: the forces over time go to
// FILE, one row a tick: milliseconds since the handle was let go, force [N] without, with.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "core/control/handle_guard.h"
#include "core/device/envelope.h"
#include "protocols/force_training/trajectory_pass.h"
#include "tests/support/pass_run.h"

namespace {

using namespace haptrial;

/// A pass that uses all of its gains, whatever the handle carries.
class Unguarded final : public protocols::Pass {
 public:
  explicit Unguarded(protocols::Pass& inner) : inner_(inner) {}
  void begin(std::uint64_t sequence) noexcept override { inner_.begin(sequence); }
  protocols::PassOutput tick(const protocols::Readings& readings, double dt) noexcept override {
    device::DeviceReading whole = readings[0];
    whole.shares = {};
    return inner_.tick(whole, dt);
  }
  protocols::PassState state() const noexcept override { return inner_.state(); }

 private:
  protocols::Pass& inner_;
};

/// Positions along y, from 100 ms before the handle is let go.
std::vector<double> let_go(const stimulus::Stimulus& stimulus, bool guarded) {
  const test::Loop loop{1000.0, 1};
  protocols::TrajectoryPass recall(protocols::kRecallTest, stimulus,
                                   protocols::GuidanceParameters{}, 1);
  Unguarded unguarded(recall);
  protocols::Pass& pass = guarded ? static_cast<protocols::Pass&>(recall) : unguarded;
  test::PassRun run(pass, loop, 0.8);
  run.advance_to(record::Stage::kRun);
  run.hand().press = 2.0;
  run.advance(1.9);
  std::vector<double> forces;
  for (int tick = 0; tick < 400; ++tick) {
    if (tick == 100) {
      run.hand().hold(0.0);
      run.hand().press = 0.0;
    }
    run.advance(1e-3);
    forces.push_back(run.idle() ? 0.0 : run.force.y());
  }
  return forces;
}

/// Median of the time of a call [ns].
template <typename Call>
double cost(Call call) {
  using Clock = std::chrono::steady_clock;
  constexpr int kCalls = 10'000;
  std::vector<double> times;
  for (int round = 0; round < 51; ++round) {
    const auto start = Clock::now();
    for (int i = 0; i < kCalls; ++i) {
      call(i);
    }
    times.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count() /
                    kCalls);
  }
  std::nth_element(times.begin(), times.begin() + 25, times.end());
  return times[25];
}

void print_costs(const stimulus::Stimulus& stimulus) {
  control::HandleGuard guard({});
  double sum = 0.0;
  fmt::print(
      "guard           {:6.1f} ns\n", cost([&](int i) {
        const Eigen::Vector3d force(0.0, 1e-2 * (i % 50), 0.0);
        sum +=
            guard.watch({0.0, 1e-3 * (i % 7), 0.0}, force, Eigen::Vector3d::Zero(), 1e-3).damping;
      }));
  device::Envelope envelope{device::EnvelopeLimits{}};
  device::DeviceReading reading;
  fmt::print("envelope        {:6.1f} ns, watching included\n", cost([&](int i) {
               reading.tool.position.x() = 1e-6 * (i % 100);
               envelope.check(true, reading);
               sum += envelope.limit({0.0, 2.0, 0.0}, 1e-3).y();
             }));
  protocols::TrajectoryPass pass(protocols::kRecallTest, stimulus, {}, 1);
  fmt::print("pass            {:6.1f} ns\n", cost([&](int i) {
               reading.tool.position.x() = 1e-6 * (i % 100);
               sum += pass.tick(reading, 1e-9).force.y();
             }));
  if (sum == 1.0) {
    fmt::print("\n");  // so that nothing is left out
  }
}

}  // namespace

int main(int argc, char** argv) {
  const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  const std::vector<double> without = let_go(stimulus, false);
  const std::vector<double> with = let_go(stimulus, true);
  const auto at_limit = [](const std::vector<double>& forces) {
    return std::ranges::count_if(forces, [](double f) { return std::abs(f) >= 0.98 * 12.0; });
  };
  fmt::print(
      "let go: {} ms at the limit without the guard, until the envelope ended it; {} ms "
      "with it\n",
      at_limit(without), at_limit(with));
  print_costs(stimulus);
  if (argc > 1) {
    std::FILE* file = std::fopen(argv[1], "w");
    if (file == nullptr) {
      fmt::print(stderr, "{} cannot be written\n", argv[1]);
      return 1;
    }
    for (std::size_t i = 0; i < with.size(); ++i) {
      fmt::print(file, "{} {:.4f} {:.4f}\n", static_cast<int>(i) - 100, without[i], with[i]);
    }
    std::fclose(file);
  }
  return 0;
}
