#include "core/bone/nerve/monitor_buffer.h"

#include <algorithm>
#include <utility>

namespace haptrial::nerve {
namespace {

/// Index at which the rows since `count` begin in a list that keeps the last ones of `all`.
std::size_t begin_of(std::uint64_t count, std::uint64_t all, std::size_t kept) {
  const std::uint64_t first = all - kept;
  return static_cast<std::size_t>(std::clamp(count, first, all) - first);
}

}  // namespace

void MonitorBuffer::show(std::vector<MonitorChannel> channels, const MonitorProbe& probe,
                         double time, bool heard) {
  const std::lock_guard lock(mutex_);
  probe_ = probe;
  channels_ = std::move(channels);
  time_ = time;
  heard_ = heard;
}

void MonitorBuffer::add_column(const std::vector<MonitorColumn>& by_channel) {
  const std::lock_guard lock(mutex_);
  columns_.push_back(by_channel);
  ++column_count_;
  if (columns_.size() > kColumns) {
    columns_.pop_front();
  }
}

void MonitorBuffer::add_event(const MonitorEvent& event) {
  const std::lock_guard lock(mutex_);
  events_.push_back(event);
  ++event_count_;
  if (events_.size() > kEvents) {
    events_.pop_front();
  }
}

std::vector<MonitorOrder> MonitorBuffer::take_orders() {
  const std::lock_guard lock(mutex_);
  return std::exchange(orders_, {});
}

MonitorBuffer::View MonitorBuffer::since(std::uint64_t column, std::uint64_t event) const {
  const std::lock_guard lock(mutex_);
  View view;
  view.time = time_;
  view.heard = heard_;
  view.probe = probe_;
  view.channels = channels_;
  view.next_column = column_count_;
  view.next_event = event_count_;
  for (std::size_t i = begin_of(column, column_count_, columns_.size()); i < columns_.size(); ++i) {
    view.columns.insert(view.columns.end(), columns_[i].begin(), columns_[i].end());
  }
  for (std::size_t i = begin_of(event, event_count_, events_.size()); i < events_.size(); ++i) {
    view.events.push_back(events_[i]);
  }
  return view;
}

void MonitorBuffer::ask(const MonitorOrder& order) {
  constexpr std::size_t kMostOrders = 100;  // that nobody has taken yet
  const std::lock_guard lock(mutex_);
  if (orders_.size() < kMostOrders) {
    orders_.push_back(order);
  }
}

}  // namespace haptrial::nerve
