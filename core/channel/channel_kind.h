#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/table.h"
#include "core/channel/channel_source.h"
#include "core/channel/sample_clock.h"

namespace haptrial::channel {

/// One channel as its keys ask for it.
struct ChannelPlan {
  std::vector<Quantity> quantities;  // 1 to kMostQuantities; none: the kind gives messages alone
  std::string path{};                // of a line that one reader has alone; empty: none
  double rate{0.0};                  // samples a second, as far as it is known; 0: it is not [Hz]
  double patience{1.0};              // without data the channel is lost > 0 [s]
  ClockOptions clock;
  /// Opens the instrument; may wait for seconds. @throws RunError in one sentence if it does not
  /// answer
  std::function<std::unique_ptr<ChannelSource>()> open;
};

/// One kind of [channels]: what its `kind` says, and how its keys are read.
struct ChannelKind {
  std::string word;
  std::string what;  // one line for lists: which instruments
  /// Problems are noted in the table.
  std::function<ChannelPlan(Table& table)> read;
};

/// Quantities that a definition names: `quantities = { force = "N", time = "s" }`, in the order of
/// the text.
std::vector<Quantity> read_quantities(Table& table, std::string_view key);
/// Notes the problems of quantities that stand under `key`: their names, and how many there are.
void check_quantities(Table& table, std::string_view key, std::vector<Quantity>& quantities);

}  // namespace haptrial::channel
