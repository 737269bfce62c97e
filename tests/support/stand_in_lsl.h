#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace haptrial::test {

/// A stream that was opened in the stand-in for liblsl, with what came through it.
struct LslStream {
  std::string name;
  std::string type;
  std::string source_id;
  std::int32_t channels{0};
  std::int32_t format{0};
  double rate{0.0};
  std::vector<std::pair<std::string, std::string>> description;  // "channels/channel/label", value
  std::vector<double> values;
  std::vector<double> timestamps;
  std::vector<double> pushed;  // when each of them came, on the layer's clock
  std::vector<std::string> texts;
  bool open{false};
};

/// The stand-in's memory; get it with dlsym("stand_in_lsl").
struct LslRecord {
  std::vector<LslStream> streams;
  int infos{0};  // descriptions that were not destroyed
  double clock{0.0};
  std::int32_t push_result{0};
  bool refuse_outlets{false};
};

/// A stream that somebody in the network offers to inlets.
struct LslOffer {
  struct Sent {
    double stamp{0.0};  // on the sender's clock [s]
    std::vector<double> values;
    std::vector<std::string> texts;
  };
  std::string name;
  std::string type;
  std::string source_id;
  std::string host;
  std::int32_t channels{1};
  std::int32_t format{2};
  double rate{0.0};
  std::vector<std::pair<std::string, std::string>> labels{};  // with units; one a channel, or none
  std::deque<Sent> sent{};                                    // and not yet pulled
  // The offset that the layer measured last, at a time on the sender's clock; 0: none yet [s].
  double offset{0.0};
  double uncertainty{0.0};
  double measured_at{0.0};
  bool gone{false};    // its inlets find that out
  bool silent{false};  // its computer answers nobody, and its inlets do not find that out
  int inlets{0};       // that are open
};

/// The network of the stand-in; get it with dlsym("stand_in_lsl_network"). Offers are used under
/// the mutex; `came` wakes an inlet that waits. A search that finds too few streams takes its whole
/// time, but for `looked_for` alone.
struct LslNetwork {
  std::mutex mutex;
  std::condition_variable came;
  std::vector<std::shared_ptr<LslOffer>> offers;
  double looked_for{0.0};  // time that searches took until they were answered or ran out [s]
  std::atomic<bool> has_clock{false};  // whether this is the layer's clock:
  std::atomic<double> clock{0.0};      // [s]
};

}  // namespace haptrial::test
