#pragma once

#include <functional>
#include <stdexcept>

namespace haptrial::geometry {

/// Long work calls this from time to time, on the thread that called it, with the share that is
/// done (0 to 1). Where it returns false the work ends with Cancelled. May be empty.
using WorkReport = std::function<bool(double share)>;

class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("the work was cancelled") {}
};

/// @throws Cancelled when the report asks to stop.
inline void report_share(const WorkReport& report, double share) {
  if (report && !report(share)) {
    throw Cancelled();
  }
}

}  // namespace haptrial::geometry
