#pragma once

#include <cstdint>
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

}  // namespace haptrial::test
