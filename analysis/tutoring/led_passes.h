#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/record/read/session_reader_forward.h"
#include "core/record/rows/session_types.h"

namespace haptrial::analysis::link {

/// How two hands kept together during one pass over a link, as one side saw it: of the ticks at
/// which they were coupled, the partner's hand where it was heard of then.
struct LedPass {
  std::string subject;
  std::uint64_t session{1};
  record::PassRow pass;
  std::string network;    // that the pass went over, where the definition names several
  double set_delay{0.0};  // of that network, one way [s]
  double coupled{0.0};    // time [s]
  double delay{0.0};      // from the partner's tick to the own, median [s]
  double lost{0.0};       // share of the partner's messages that never came
  double apart{0.0};      // distance of the hands, root mean square [m]
  double farthest{0.0};   // [m]
  double coupling{0.0};   // force of the link on the own hand, root mean square [N]
  double given{0.0};      // energy to the own hand, less what it gave [J]
};

/// The completed passes of a session in which hands were coupled; none of a session without a link.
/// Practice counts as little as elsewhere. A pass in memory at a time.
/// @throws InputError where the file is damaged
std::vector<LedPass> led_passes(const record::SessionReader& reader);

}  // namespace haptrial::analysis::link
