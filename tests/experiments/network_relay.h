#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

namespace haptrial::test {

/// Effects of the relay on datagrams, each way.
struct RelayConditions {
  double delay{0.0};        // [s]
  double jitter{0.0};       // mean of what comes on top, exponential [s]
  double loss{0.0};         // share
  double duplication{0.0};  // share
  double reordering{0.0};   // share that does not wait for those before it
};

/// A bad network on one machine: a port that hands connections on to another port as they are, and
/// datagrams late, not at all, twice or out of turn. Real time, a thread of its own.
class NetworkRelay {
 public:
  /// @param to  port of this machine
  NetworkRelay(std::uint16_t to, const RelayConditions& conditions, std::uint64_t seed = 1);
  ~NetworkRelay();
  NetworkRelay(const NetworkRelay&) = delete;
  NetworkRelay& operator=(const NetworkRelay&) = delete;

  std::uint16_t port() const noexcept { return port_; }
  /// Nothing comes through while it is cut.
  void cut(bool is) noexcept { cut_ = is; }
  std::uint64_t lost() const noexcept { return lost_; }
  std::uint64_t passed() const noexcept { return passed_; }

 private:
  void run();

  std::uint16_t to_;
  RelayConditions conditions_;
  std::uint64_t seed_;
  std::uint16_t port_{0};
  int listener_{-1};
  int guest_{-1};  // datagrams, to and from who came to this port
  int host_{-1};   // datagrams, to and from the other port
  std::atomic<bool> stop_{false};
  std::atomic<bool> cut_{false};
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint64_t> passed_{0};
  std::thread thread_;
};

}  // namespace haptrial::test
