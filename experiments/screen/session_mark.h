#pragma once

#include <string>

namespace haptrial::experiments {

/// A mark over every picture of a session.
struct SessionMark {
  std::string words;   // in the upper left corner; empty: none
  bool framed{false};  // in orange: the session does not count
};

}  // namespace haptrial::experiments
