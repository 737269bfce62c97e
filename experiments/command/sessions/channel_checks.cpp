#include "experiments/command/sessions/channel_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/base/exception_words.h"
#include "core/channel/channel_set.h"
#include "core/record/rows/common_tables.h"

namespace haptrial::experiments {
namespace {

using State = MachineCheck::State;
using Clock = std::chrono::steady_clock;

bool all_live(const channel::ChannelSet& channels) {
  return std::ranges::all_of(channels.seen(), [](const auto& seen) { return seen.state.live; });
}

/// Gives the instruments a moment to send something.
void wait_for_data(channel::ChannelSet& channels, Clock::time_point begin) {
  constexpr std::chrono::milliseconds kLook{20}, kLongest{2000};
  const auto now_ns = [&] { return std::chrono::nanoseconds(Clock::now() - begin).count(); };
  const auto end = Clock::now() + kLongest;
  channels.begin();
  while (!all_live(channels) && Clock::now() < end) {
    std::this_thread::sleep_for(kLook);
    channels.collect(now_ns(), [](const record::Rows&) {});
  }
}

MachineCheck check_of(const channel::ChannelSet::Seen& seen,
                      const std::vector<std::string>& missing) {
  const channel::ChannelOptions& options = *seen.options;
  if (seen.state.live) {
    const auto quantities = std::min(options.plan.quantities.size(), seen.state.values.size());
    const std::vector<double> values(seen.state.values.begin(),
                                     seen.state.values.begin() + static_cast<long>(quantities));
    return {"channel " + options.name, State::kReady,
            fmt::format("answers; newest values {:.4g}", fmt::join(values, ", "))};
  }
  const auto why = std::ranges::find_if(missing, [&](const std::string& sentence) {
    return sentence.find(options.name) != std::string::npos;
  });
  return {"channel " + options.name, options.required ? State::kBroken : State::kLimited,
          why != missing.end() ? *why : "is open but sends nothing; check instrument and cable"};
}

}  // namespace

std::vector<MachineCheck> channel_checks(const Experiment& experiment) {
  const protocols::Definition& d = *experiment.definition;
  if (d.channels.empty()) {
    return {};
  }
  try {
    const record::TableList tables =
        record::with_tables(experiment.study->protocol().tables(), record::common_tables());
    channel::ChannelSet channels(d.channels, tables, true);
    const Clock::time_point begin = Clock::now();
    const std::vector<std::string> missing = channels.start(
        [begin] { return std::chrono::nanoseconds(Clock::now() - begin).count(); }, {});
    wait_for_data(channels, begin);
    std::vector<MachineCheck> checks;
    for (const auto& seen : channels.seen()) {
      checks.push_back(check_of(seen, missing));
    }
    return checks;
  } catch (const std::exception& error) {
    return {{"channels", State::kBroken, sentence_of(error)}};
  }
}

}  // namespace haptrial::experiments
