#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "core/record/table/table.h"

namespace haptrial::record {

/// State of a session's link to a partner at one tick, a row of /link. The own hand is in /samples.
/// Messages are numbered from 1 on either side, so that `heard` is a row of the partner's file: the
/// one whose `sent` it is.
struct LinkRow {
  std::uint64_t sequence{0};  // of the tick, as in /samples
  std::int64_t sent{0};       // number of the message that left; 0: none
  std::int64_t heard{0};      // number of the partner's message that the tick goes by; 0: none yet
  std::int32_t arrived{0};    // messages since the tick before
  std::int32_t lost{0};       // of the partner's messages so far that never came
  std::uint8_t state{0};      // LinkState
  double lead{0.0};           // own authority over the own tool, 0 to 1
  double delay{0.0};          // from the partner's tick to this one, by the clock's offset [s]
  double round_trip{0.0};     // of the last answer [s]
  double clock_offset{0.0};   // partner's clock less the own [s]
  double clock_drift{0.0};    // how much faster the partner's runs [1]
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // of the partner's tool, in W [m]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};  // [m/s]
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};     // of the partner's world on it, in W [N]
  Eigen::Vector3d coupling{Eigen::Vector3d::Zero()};  // of the link on the own tool, in W [N]
  double energy{0.0};                                 // that may still be given to the hand [J]
  double energy_given{0.0};                           // to the hand so far, less what it gave [J]
  double energy_sent{0.0};                            // to the partner so far [J]
  double energy_received{0.0};                        // from the partner so far [J]
};

enum LinkState : std::uint8_t {
  kLinked = 1,          // the partner was heard within the deadline
  kLinkEngaged = 2,     // both hands are coupled
  kPartnerStops = 4,    // an emergency stop is on at the partner's
  kPartnerFault = 8,    // the partner's device has a fault
  kPartnerClaims = 16,  // the partner has taken the lead
};

template <>
const Table<LinkRow>& table_of<LinkRow>();

/// The network that a pass of a dry run went over, a row of /networks. Each way.
struct NetworkRow {
  std::int32_t pass{0};  // row of /trials
  std::string name;      // as the definition calls it
  double delay{0.0};     // least [s]
  double jitter{0.0};    // mean of what comes on top [s]
  double loss{0.0};      // share
  double duplication{0.0};
  double reordering{0.0};
  double bandwidth{0.0};  // [bytes/s]; 0: no limit
};

template <>
const Table<NetworkRow>& table_of<NetworkRow>();

/// One tick during which a tutor leads the first device's tool, a row of /tutoring.
struct TutoringRow {
  std::uint64_t sequence{0};  // of the tick, as in /samples
  double time{0.0};           // in what the tutor did, from the beginning of his run [s]
  double lead{0.0};           // the tutor's authority, 0 to 1
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};      // of the tutor's tool, in W [m]
  Eigen::Vector3d tutor_force{Eigen::Vector3d::Zero()};   // on it, in W [N]
  Eigen::Vector3d played_force{Eigen::Vector3d::Zero()};  // of the tutor on the own tool, in W [N]
};

template <>
const Table<TutoringRow>& table_of<TutoringRow>();

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
