#pragma once

#include <cstdint>

namespace haptrial::record {

/// How the link to a partner's session stands.
struct PartnerState {
  bool heard{false};    // at all
  bool linked{false};   // within the deadline
  bool coupled{false};  // each hand feels what the other does
  bool claims{false};   // this side has taken the lead
  bool other_claims{false};
  bool over{false};          // the partner has presented all trials
  bool left{false};          // the partner's session has ended with trials left
  bool stops{false};         // an emergency stop is on at the partner's
  double silence{0.0};       // since the newest message, or the first tick [s]
  double lead{1.0};          // own authority over the own tool, 0 to 1
  double round_trip{-1.0};   // of the last answer; -1: none yet [s]
  double jitter{0.0};        // mean change of the delay from message to message (RFC 3550) [s]
  double loss{0.0};          // share of the last second's messages, 0 to 1
  double energy{0.0};        // that may still be given to the hand [J]
  double clock_offset{0.0};  // partner's clock less the own [s]
  double clock_drift{0.0};   // how much faster the partner's runs [1]
  std::uint64_t losses{0};   // of the link
  bool operator==(const PartnerState&) const = default;
};

}  // namespace haptrial::record
