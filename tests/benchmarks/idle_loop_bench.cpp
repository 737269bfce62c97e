// A servo loop that does nothing: what the machine itself adds to any loop of that rate.
// bench_idle_loop [RATE SECONDS], 1000 Hz and 10 s by default.

#include <fmt/format.h>

#include <cstdlib>

#include "core/realtime/servo_loop.h"

namespace {

class Nothing final : public haptrial::realtime::ServoTask {
 public:
  explicit Nothing(std::uint64_t ticks) : ticks_(ticks) {}
  bool tick(const haptrial::realtime::Tick& tick) noexcept override {
    return tick.index + 1 < ticks_;
  }

 private:
  std::uint64_t ticks_;
};

}  // namespace

int main(int argc, char** argv) {
  const double rate = argc > 1 ? std::atof(argv[1]) : 1000.0;
  const double seconds = argc > 2 ? std::atof(argv[2]) : 10.0;
  Nothing nothing(static_cast<std::uint64_t>(rate * seconds));
  haptrial::realtime::ServoLoop loop(haptrial::realtime::ClockKind::kReal, rate);
  loop.run(nothing);
  const auto& lateness = loop.timing().lateness;
  fmt::print("lateness    median {:.2f}, 99 % {:.2f}, 99.9 % {:.2f}, worst {:.2f} us; {} ticks\n",
             lateness.percentile(50.0) * 1e-3, lateness.percentile(99.0) * 1e-3,
             lateness.percentile(99.9) * 1e-3, lateness.max() * 1e-3, loop.ticks());
  return 0;
}
