#include "tests/experiments/session_runs.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "experiments/runner/session.h"

namespace haptrial::test {

using experiments::SessionRequest;

SessionRequest session_request(const protocols::Protocol& protocol,
                               const protocols::Definition& definition,
                               const std::filesystem::path& file, std::uint64_t seed,
                               const std::string& subject) {
  SessionRequest request;
  request.protocol = &protocol;
  request.definition = &definition;
  request.subject = subject;
  request.seed = seed;
  request.file = file;
  return request;
}

SessionRequest session_request(const experiments::Experiment& experiment,
                               const std::filesystem::path& file, std::uint64_t seed,
                               const std::string& subject) {
  return session_request(experiment.study->protocol(), *experiment.definition, file, seed, subject);
}

void run_and_kill(SessionRequest request, std::uint64_t at_tick) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::atomic<std::uint64_t> ticks{0};
    std::thread([&] {
      while (ticks.load() < at_tick) {
        std::this_thread::sleep_for(std::chrono::microseconds(200));
      }
      ::kill(::getpid(), SIGKILL);
    }).detach();
    request.clock = realtime::ClockKind::kReal;
    request.ticks = &ticks;
    experiments::run_session(request);
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "it came to its end before it was killed";
}

}  // namespace haptrial::test
