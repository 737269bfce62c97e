#pragma once

#include <vector>

namespace haptrial::record {
class SessionReader;
}

namespace haptrial::exchange {

/// When a pass was, by the session's clock.
struct PassSpan {
  double onset{0.0};     // of its first tick, since the first tick of the session [s]
  double duration{0.0};  // to the end of its last tick; 0: it has none [s]
};

/// The spans of all passes. A loop that was suspended shifts the clock against the numbers of the
/// ticks, so that these do not tell the time. A session without samples has that of the numbers.
/// @throws InputError when the file is damaged.
std::vector<PassSpan> pass_spans(const record::SessionReader& reader);

}  // namespace haptrial::exchange
