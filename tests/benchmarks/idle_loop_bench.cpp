// A servo loop that does nothing: what the machine itself adds to any loop of that rate.
// bench_idle_loop [RATE SECONDS [HISTOGRAM.csv]], 1000 Hz and 10 s by default.

#include <fmt/format.h>
#include <fmt/os.h>

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

void write_histogram(const char* file, const haptrial::realtime::DurationHistogram& lateness) {
  auto out = fmt::output_file(file);
  out.print("bin_high_ns,lateness_count\n");
  for (std::size_t i = 0; i < haptrial::realtime::DurationHistogram::kBins; ++i) {
    const auto bin = lateness.bin(i);
    if (bin.count > 0) {
      out.print("{},{}\n", bin.high, bin.count);
    }
  }
}

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
  if (argc > 3) {
    write_histogram(argv[3], lateness);
  }
  return 0;
}
