#include "core/channel/channel_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/record/rows/common_tables.h"

namespace haptrial::channel {
namespace {

constexpr double kSimulatedRate = 100.0;  // where a plan states none [Hz]
constexpr double kChunk = 0.5;            // of a table, so that no more is lost in a kill [s]
constexpr std::size_t kLeastChunk = 16;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double rate_of(const ChannelPlan& plan) { return plan.rate > 0.0 ? plan.rate : kSimulatedRate; }

/// A table whose chunks are about half a second long, and no other table's.
std::unique_ptr<ChannelTable> table_beside(const ChannelOptions& options,
                                           const record::TableList& others) {
  const auto wanted = static_cast<std::size_t>(kChunk * rate_of(options.plan));
  std::size_t rows = std::clamp(wanted, kLeastChunk, record::kLongestChunk);
  for (;; ++rows) {
    auto table = std::make_unique<ChannelTable>(options.name, options.plan.quantities, rows);
    record::TableList all = others;
    all.push_back(&table->table());
    try {
      record::check_chunk_sizes(all);
      return table;
    } catch (const std::invalid_argument&) {
      continue;  // another table has chunks of this size
    }
  }
}

double simulated(const SimulatedInput& input, double time) {
  return input.mean + input.amplitude * std::sin(2.0 * std::numbers::pi * input.frequency * time);
}

}  // namespace

ChannelSet::ChannelSet(const std::vector<ChannelOptions>& options, const record::TableList& tables,
                       bool real)
    : real_(real) {
  record::TableList others = tables;
  if (!options.empty()) {
    others = record::with_tables(others, {&record::table_of<IncidentRow>()});
    record::check_chunk_sizes(others);
  }
  for (const ChannelOptions& each : options) {
    Part part;
    part.options = each;
    part.table = table_beside(each, others);
    others.push_back(&part.table->table());
    part.at = values_.size();
    part.lost = fmt::format("channel {} is lost", each.name);
    for (const Quantity& quantity : each.plan.quantities) {
      part.beyond.push_back(fmt::format("channel {}: {} is beyond the limit of {:g} {}", each.name,
                                        quantity.name, each.limit.value_or(0.0), quantity.unit));
      values_.push_back(kNone);
    }
    parts_.push_back(std::move(part));
  }
  arrived_.reserve(values_.size());
}

record::TableList ChannelSet::tables() const {
  record::TableList tables;
  for (const Part& part : parts_) {
    tables.push_back(&part.table->table());
  }
  if (!parts_.empty()) {
    tables.push_back(&record::table_of<IncidentRow>());
  }
  return tables;
}

std::vector<std::string> ChannelSet::start(const Channel::Now& now,
                                           const std::vector<std::uint64_t>& first) {
  std::vector<std::string> notices;
  std::size_t most_arrived = values_.size();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    part.next = i < first.size() ? first[i] : 0;
    if (real_) {
      part.channel = std::make_unique<Channel>(part.options, now, part.next);
      most_arrived += part.channel->unseen().capacity() * part.options.plan.quantities.size();
    }
  }
  arrived_.reserve(most_arrived);
  for (Part& part : parts_) {
    const std::string why = part.channel ? part.channel->wait_until_open() : "";
    if (!why.empty() && part.options.required) {
      throw RunError(fmt::format("channel {}: {}; the session needs it (required = true)",
                                 part.options.name, why));
    }
    part.missing = !why.empty();
    if (part.missing) {
      notices.push_back(
          fmt::format("channel {}: {}; the session goes on without it, and looks "
                      "for it twice a second",
                      part.options.name, why));
    }
  }
  return notices;
}

void ChannelSet::begin() {
  for (Part& part : parts_) {
    if (part.channel) {
      part.channel->begin();
    }
  }
}

void ChannelSet::collect(std::int64_t now_ns, const std::function<void(const record::Rows&)>& put) {
  std::vector<IncidentRow> incidents;
  for (Part& part : parts_) {
    if (!part.channel) {
      simulate(part, now_ns, put);
      continue;
    }
    part.channel->log().flush([&](std::span<const ChannelRow> rows) {
      put(record::Rows(part.table->table(), rows.data(), rows.size()));
    });
    for (IncidentRow& row : part.channel->take_incidents()) {
      const bool lost = row.what == Incident::kLost && !std::exchange(part.missing, false);
      if (lost) {
        news_.push_back(fmt::format("channel {} is lost: {}", row.channel, row.text));
      } else if (row.what == Incident::kClockStep && !row.text.empty()) {
        news_.push_back(fmt::format("the clock of channel {}: {}", row.channel, row.text));
      } else if (row.what == Incident::kStatus && row.amount != 0.0) {
        news_.push_back(fmt::format("channel {}: {}", row.channel, row.text));
      } else if (row.what == Incident::kBack) {
        news_.push_back(fmt::format("channel {} is back after {:.1f} s", row.channel, row.amount));
      }
      incidents.push_back(std::move(row));
    }
  }
  if (!incidents.empty()) {
    put(record::Rows(std::span<const IncidentRow>(incidents)));
  }
}

/// The samples up to now, as an instrument of the stated rate would have given them.
void ChannelSet::simulate(Part& part, std::int64_t now_ns,
                          const std::function<void(const record::Rows&)>& put) {
  if (part.options.plan.quantities.empty()) {
    return;  // messages alone
  }
  std::vector<ChannelRow> rows;
  const double rate = rate_of(part.options.plan);
  for (;; ++part.next) {
    ChannelRow row;
    row.sample = part.next;
    row.device_time = static_cast<double>(part.next) / rate;
    row.time_ns = row.received_ns = std::llround(1e9 * row.device_time);
    if (row.time_ns >= now_ns) {
      break;
    }
    std::fill_n(row.values.begin(), part.options.plan.quantities.size(),
                simulated(part.options.simulated, row.device_time));
    rows.push_back(row);
  }
  if (!rows.empty()) {
    put(record::Rows(part.table->table(), rows.data(), rows.size()));
  }
}

std::vector<std::string> ChannelSet::take_news() { return std::exchange(news_, {}); }

void ChannelSet::take(std::int64_t time_ns) noexcept {
  alarm_ = Alarm::kNone;
  sentence_ = "";
  arrived_.clear();
  for (Part& part : parts_) {
    const std::size_t count = part.options.plan.quantities.size();
    bool lost = false;
    std::optional<std::size_t> beyond;
    if (part.channel) {
      const ChannelState& state = part.channel->newest();
      lost = state.lost;
      for (std::size_t i = 0; i < count; ++i) {
        values_[part.at + i] = state.live ? state.values[i] : kNone;
      }
      if (std::exchange(part.judged, state.beyond) != state.beyond) {
        beyond = state.beyond_value;
      }
      take_arrived(part, time_ns);
    } else if (!real_) {
      std::fill_n(values_.begin() + static_cast<std::ptrdiff_t>(part.at), count,
                  simulated(part.options.simulated, 1e-9 * static_cast<double>(time_ns)));
      for (std::size_t place = part.at; place < part.at + count; ++place) {
        arrived_.push_back({place, values_[place], 0.0});
      }
    }
    judge(part, lost, beyond);
  }
}

void ChannelSet::take_arrived(Part& part, std::int64_t time_ns) noexcept {
  part.channel->unseen().flush([&](std::span<const ChannelRow> rows) {
    for (const ChannelRow& row : rows) {
      const double age = 1e-9 * static_cast<double>(time_ns - row.time_ns);
      for (std::size_t i = 0; i < part.options.plan.quantities.size(); ++i) {
        arrived_.push_back({part.at + i, row.values[i], age});
      }
    }
  });
}

/// A value beyond its limit weighs more than a channel that is lost.
/// @param beyond  quantity of a sample since the last tick; the newest value is judged here
void ChannelSet::judge(const Part& part, bool lost, std::optional<std::size_t> beyond) noexcept {
  if (lost && part.options.required && alarm_ == Alarm::kNone) {
    alarm_ = Alarm::kLost;
    sentence_ = part.lost.c_str();
  }
  if (!part.options.limit || alarm_ == Alarm::kBeyond) {
    return;
  }
  for (std::size_t i = 0; i < part.beyond.size() && !beyond; ++i) {
    if (std::abs(values_[part.at + i]) > *part.options.limit) {
      beyond = i;
    }
  }
  if (beyond) {
    alarm_ = Alarm::kBeyond;
    sentence_ = part.beyond[*beyond].c_str();
  }
}

std::vector<ChannelSet::Seen> ChannelSet::seen() const {
  std::vector<Seen> all;
  for (const Part& part : parts_) {
    if (part.options.console) {
      all.push_back({&part.options, part.channel ? part.channel->seen() : ChannelState{}});
    }
  }
  return all;
}

}  // namespace haptrial::channel
