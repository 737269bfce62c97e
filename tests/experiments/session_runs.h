#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"

namespace haptrial::test {

/// A session of a virtual participant on the simulated clock.
experiments::SessionRequest session_request(const protocols::Protocol& protocol,
                                            const protocols::Definition& definition,
                                            const std::filesystem::path& file, std::uint64_t seed,
                                            const std::string& subject = "S01");
experiments::SessionRequest session_request(const experiments::Experiment& experiment,
                                            const std::filesystem::path& file, std::uint64_t seed,
                                            const std::string& subject = "S01");

/// Runs a session on the real clock in a process of its own, which is killed once it has done so
/// many ticks; a failure if it came to its end before.
void run_and_kill(experiments::SessionRequest request, std::uint64_t at_tick);

}  // namespace haptrial::test
