#include "experiments/control/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace haptrial::experiments {

using Clock = std::chrono::steady_clock;

Progress::Progress(std::string what, double total)
    : what_(std::move(what)),
      total_(total),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (width_ > 0) {
    fmt::print(stderr, "\r{:{}}\r", "", width_);
    std::fflush(stderr);
  }
}

void Progress::update(double done, const std::string& detail, double real_time_rate) {
  constexpr std::chrono::milliseconds kBetween{200};
  const auto now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  if (!terminal_ || elapsed < 2.0 || now - last_ < kBetween || done <= 0.0) {
    return;
  }
  last_ = now;
  const double share = std::min(done / total_, 0.99);  // the total is an estimate
  std::string line = fmt::format("{}: {:2.0f} %, ", what_, 100.0 * share);
  if (!detail.empty()) {
    line += detail + ", ";
  }
  if (real_time_rate > 0.0) {
    line += fmt::format("{:.2g} times real time, ", done / real_time_rate / elapsed);
  }
  line += fmt::format("{:.0f} s left", elapsed * (1.0 - share) / share);
  fmt::print(stderr, "\r{:{}}", line, width_);
  std::fflush(stderr);
  width_ = std::max(width_, line.size());
}

}  // namespace haptrial::experiments
