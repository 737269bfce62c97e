// A session on the real clock with its recorder: as many records as periods, and how late ticks
// start. bench_servo [SECONDS], 60 by default.

#include <fmt/format.h>

#include <cstdlib>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "tests/experiments/timed_session.h"
#include "tests/support/temporary_folder.h"

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 60.0;
  const auto ticks = static_cast<std::uint64_t>(seconds * 1000.0);
  const haptrial::test::TemporaryFolder folder;
  const auto session = haptrial::test::run_timed_session(ticks, folder / "S01.h5");
  const haptrial::record::SessionReader reader(folder / "S01.h5");
  fmt::print("{} periods of 1 ms in {:.4f} s: {} records, {} gaps, {} lost, {} overruns\n", ticks,
             session.seconds, reader.sample_count(), haptrial::record::check_session(reader).gaps,
             session.dropped, session.overruns);
  fmt::print("{}\n", session.status.notice.empty() ? "real-time priority and locked memory"
                                                   : session.status.notice);
  fmt::print("{:<10}{:>10}{:>10}{:>10}{:>10}  [us]\n", "", "median", "99 %", "99.9 %", "worst");
  const auto row = [](const char* name, const haptrial::realtime::DurationHistogram& h) {
    fmt::print("{:<10}{:>10.2f}{:>10.2f}{:>10.2f}{:>10.2f}\n", name, h.percentile(50.0) * 1e-3,
               h.percentile(99.0) * 1e-3, h.percentile(99.9) * 1e-3, h.max() * 1e-3);
  };
  row("lateness", session.timing.lateness);
  row("period", session.timing.period);
  row("compute", session.timing.compute);
  return reader.sample_count() == ticks && session.dropped == 0 ? 0 : 1;
}
