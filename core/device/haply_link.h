#pragma once

#include <memory>
#include <string>

#include "core/device/haply_frame.h"

namespace haptrial::device {

/// Way to one device of the Inverse Service, and how long either side may be silent.
struct HaplyAddress {
  int port{0};            // 0: 10001, and 10000 if nobody answers there
  std::string device_id;  // empty: the first one that the service lists
  std::string grip_id;    // empty: the first one, or none if there is none
  int number{0};          // of several sessions' devices, from 0: counted from the one above
  double patience{0.018};  // without a command for so long the link commands no force > 0 [s]
};

/// A WebSocket to the Inverse Service, on a thread of its own. The service gives one state for each
/// message and nothing by itself, and a command holds for one of its ticks: the link sends the
/// newest force as soon as a state has come, but no sooner than 250 µs after the message before,
/// and sends again if no state comes within a quarter of the patience.
class HaplyLink {
 public:
  /// Connects, and waits for the first state.
  /// @throws RunError when no service answers or it lists no such device
  explicit HaplyLink(const HaplyAddress& address);
  /// Commands no force and closes the connection.
  ~HaplyLink();

  const HaplyListing& device() const noexcept;
  bool has_grip() const noexcept;
  const std::string& version() const noexcept;  // of the service; empty: it states none

  /// The newest state, if there is one since the last call. A fault that was found in between is
  /// kept for the patience, unless a later one replaces it. Servo thread: wait-free.
  bool read(HaplyState& state) noexcept;
  /// @param force  in the service's axes [N]. Servo thread: wait-free.
  void write(const Eigen::Vector3d& force) noexcept;

 private:
  class Connection;
  std::unique_ptr<Connection> connection_;
};

/// A service that answers, and what it lists.
struct HaplyService {
  int port{0};
  std::string version;
  HaplyInventory inventory;
};

/// Connects and reads what the service lists. @throws RunError when no service answers
HaplyService find_haply_service(int port);

}  // namespace haptrial::device
