#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/stand_in_handle.h"

namespace haptrial::test {

/// A stand-in for Haply's Inverse Service: a WebSocket on this computer that lists devices and
/// grips, gives one state for each message, and applies a command for one of its own ticks. Behind
/// each device is the same simulated handle, in the service's axes; it fails on command.
class HaplyService {
 public:
  struct Options {
    double rate{4000.0};  // of its ticks [Hz]; 0: step() is a tick
    std::string version{"3.5.0.0"};
    std::string type{"inverse3"};
    std::vector<std::string> devices{"049D"};
    std::vector<std::string> grips{"61548"};
    std::string basis{"XYZ"};
    int port{0};  // 0: a free one
  };
  /// The middle of the handle's workspace in the service's axes [m].
  static constexpr std::array<double, 3> kMiddle{0.0, -0.12, 0.15};

  HaplyService() : HaplyService(Options{}) {}
  explicit HaplyService(const Options& options);
  ~HaplyService();
  HaplyService(const HaplyService&) = delete;
  HaplyService& operator=(const HaplyService&) = delete;

  int port() const noexcept { return port_; }
  /// [haply] of a definition for this service.
  std::string table() const;
  /// A tick, answered at once; waits for the client's next message, unless it fails silently. Only
  /// with a rate of 0.
  void step();
  /// Fails from this tick on, counted from now.
  void fail(Failure failure, long ticks = 0);
  /// Changes the handle, or reads it, between two ticks.
  void with_handle(const std::function<void(StandInHandle&)>& change);
  /// A hand that acts before every tick. @param seconds  of ticks since the start
  void set_hand(std::function<void(StandInHandle&, double seconds)> hand);
  void turn_grip(double w, double x, double y, double z);
  /// Dies as a killed program does: every connection is reset, and nobody listens.
  void kill();

  /// Force that the motors give in this tick, in the service's axes [N].
  std::array<double, 3> force();
  double force_size();
  long ticks();
  long messages();
  std::string first_message();  // of the newest client
  bool has_client();

 private:
  struct Client;
  void listen();
  void serve(Client& client);
  void tick_on();
  void tick();
  bool answer(Client& client);
  void take(Client& client, const std::string& message);
  std::string inventory();
  std::string state(Failure failure);
  std::string device_state(Failure failure);

  Options options_;
  int port_{0};
  std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  StandInHandle handle_;
  std::function<void(StandInHandle&, double)> hand_;
  std::array<double, 4> grip_{1.0, 0.0, 0.0, 0.0};
  std::array<double, 3> commanded_{};
  bool fresh_{false};  // a command came since the last tick
  long messages_{0};
  long answers_{0};
  std::string first_;
  bool dead_{false};
  std::list<std::unique_ptr<Client>> clients_;
  int listener_{-1};
  std::thread listening_;
  std::thread ticking_;
};

}  // namespace haptrial::test
