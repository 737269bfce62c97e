#include "experiments/study/taught_session.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <thread>
#include <vector>

#include "core/base/one_processor.h"
#include "core/base/random.h"
#include "core/tutoring/simulated_link.h"

namespace haptrial::experiments {
namespace {

protocols::LinkChoice choice(const std::shared_ptr<tutoring::SimulatedLink>& link,
                             protocols::LinkRole role) {
  const bool teaches = role == protocols::LinkRole::kTeaches;
  return {role, {link, &link->end(teaches ? 0 : 1)}, "simulated"};
}

/// Closes the end whatever comes, so that the other side does not wait for it.
SessionSummary run_side(const SessionRequest& request) {
  const std::shared_ptr<tutoring::Wire> wire = request.link->wire;
  try {
    SessionSummary done = run_session(request);
    wire->close({});
    return done;
  } catch (...) {
    wire->close({});
    throw;
  }
}

}  // namespace

SessionSummary run_taught_session(const SessionRequest& request,
                                  const std::filesystem::path& folder) {
  const protocols::Definition& d = *request.definition;
  const std::vector<protocols::TutoringNetwork>& networks = d.tutoring.networks;
  double least = d.tutoring.channel.delay;
  if (!networks.empty()) {
    least = std::ranges::min_element(networks, {}, [](const auto& n) {
              return n.channel.delay;
            })->channel.delay;
  }
  const auto link = std::make_shared<tutoring::SimulatedLink>(
      networks.empty() ? d.tutoring.channel : networks.front().channel, least,
      derived_seed(request.seed, "link " + request.subject), d.rate);
  SessionRequest learns = request;
  SessionRequest teaches = request;
  learns.link = choice(link, protocols::LinkRole::kLearns);
  teaches.link = choice(link, protocols::LinkRole::kTeaches);
  teaches.file = request.file.parent_path() / folder / request.file.filename();
  teaches.frames_per_pass = 0;
  teaches.ticks = nullptr;
  const OneProcessor beside;  // their ticks take turns
  std::exception_ptr failure;
  std::thread teacher([&] {
    try {
      run_side(teaches);
    } catch (...) {
      failure = std::current_exception();
    }
  });
  SessionSummary done;
  std::exception_ptr own;
  try {
    done = run_side(learns);
  } catch (...) {
    own = std::current_exception();
  }
  teacher.join();
  if (own || failure) {
    std::rethrow_exception(own ? own : failure);
  }
  return done;
}

}  // namespace haptrial::experiments
