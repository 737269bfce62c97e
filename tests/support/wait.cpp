#include "tests/support/wait.h"

#include <chrono>
#include <cstdio>
#include <thread>

namespace haptrial::test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPause{10};

}  // namespace

void wait_until(const std::function<bool()>& condition, const std::source_location& where,
                const std::function<std::string()>& state) {
  constexpr std::chrono::minutes kSilence{1};
  auto said = Clock::now();
  while (!condition()) {
    std::this_thread::sleep_for(kPause);
    if (Clock::now() - said > kSilence) {
      said = Clock::now();
      std::fprintf(stderr, "%s:%u: still waiting\n%s", where.file_name(), where.line(),
                   state ? state().c_str() : "");
    }
  }
}

bool happens_within(double seconds, const std::function<bool()>& condition) {
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (Clock::now() > end) {
      return false;
    }
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

}  // namespace haptrial::test
