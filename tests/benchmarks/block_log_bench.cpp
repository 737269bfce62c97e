// The block log beside two well-known single-producer queues, one run, one table.
//
// A producer and a consumer thread, each on its own processor; the consumer polls without pause or
// sleeps 1 ms after it has emptied the queue. Flat out: bursts of half the capacity, pushed as fast
// as the queue allows; the median is over whole bursts, the 99.9th percentile over pushes timed one
// by one. Paced: one push every 10 µs. Times of single pushes include the clock, whose own cost is
// printed. The queues take turns in short rounds, because what a cache line costs from processor to
// processor drifts on a virtual machine; each figure is the median over the rounds.

#include <fmt/core.h>
#include <pthread.h>
#include <readerwriterqueue/readerwriterqueue.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

#include "core/realtime/block_log.h"

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kSlots = 65536;
constexpr std::size_t kBurst = kSlots / 2;
constexpr int kRounds = 9;
constexpr int kBursts = 40;            // of a round, timed as a whole
constexpr int kSteppedBursts = 8;      // of a round, timed push by push
constexpr std::size_t kPaced = 10240;  // pushes of a round; whole blocks
constexpr double kPaceNs = 10e3;

template <std::size_t kBytes>
struct Record {
  std::uint64_t sequence;
  std::array<std::uint64_t, kBytes / 8 - 1> payload;
};

// Each queue behind the same two calls: push, and consume (everything there is).
template <class R>
struct BlockLogDrained {
  haptrial::realtime::BlockLog<R> queue{1024, kSlots / 1024};
  bool push(const R& r) { return queue.push(r); }
  template <class F>
  std::size_t consume(F&& f) {
    return queue.drain([&](auto block) { std::for_each(block.begin(), block.end(), f); });
  }
};
template <class R>
struct BlockLogFlushed {
  haptrial::realtime::BlockLog<R> queue{1024, kSlots / 1024};
  bool push(const R& r) { return queue.push(r); }
  template <class F>
  std::size_t consume(F&& f) {
    return queue.flush([&](auto block) { std::for_each(block.begin(), block.end(), f); });
  }
};
template <class R>
struct Moodycamel {
  moodycamel::ReaderWriterQueue<R> queue{kSlots};
  bool push(const R& r) { return queue.try_enqueue(r); }
  template <class F>
  std::size_t consume(F&& f) {
    std::size_t n = 0;
    for (R r; queue.try_dequeue(r); ++n) {
      f(r);
    }
    return n;
  }
};
template <class R>
struct Boost {
  boost::lockfree::spsc_queue<R> queue{kSlots};
  bool push(const R& r) { return queue.push(r); }
  template <class F>
  std::size_t consume(F&& f) {
    return queue.consume_all(f);
  }
};

void pin(unsigned cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(cpu % std::max(1u, std::thread::hardware_concurrency()), &set);
  pthread_setaffinity_np(pthread_self(), sizeof set, &set);
}

// The processor's own counter where there is one: the system's clock counts in steps of 10 ns.
std::uint64_t now() {
#if defined(__x86_64__)
  unsigned aux;
  const std::uint64_t count = __rdtscp(&aux);
  _mm_lfence();
  return count;
#else
  return static_cast<std::uint64_t>(Clock::now().time_since_epoch().count());
#endif
}

double ns_per_count() {
  const auto start = Clock::now();
  const std::uint64_t first = now();
  while (Clock::now() - start < std::chrono::milliseconds(50)) {
  }
  const auto elapsed = std::chrono::duration<double, std::nano>(Clock::now() - start);
  return elapsed.count() / static_cast<double>(now() - first);
}
const double kNsPerCount = ns_per_count();

double ns_since(std::uint64_t start) { return kNsPerCount * static_cast<double>(now() - start); }

double quantile(std::vector<double> v, double q) {
  const auto nth = v.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(v.size() - 1));
  std::nth_element(v.begin(), nth, v.end());
  return *nth;
}

enum class Consumer { kPolls, kSleeps };
enum Figure { kFlatMedian, kFlatTail, kPacedMedian, kPacedTail, kFigures };
using Figures = std::array<double, kFigures>;  // [ns]

// One queue with its consumer thread; idle between rounds.
template <class Queue, class R>
class Run {
 public:
  explicit Run(Consumer kind) : kind_(kind), consumer_([this] { consume(); }) {}
  ~Run() {
    stop_ = true;
    consumer_.join();
  }

  Figures round() {
    active_ = true;
    Figures figures{};
    std::vector<double> times;
    for (int i = 0; i < kBursts; ++i) {
      const std::uint64_t start = now();
      push(kBurst);
      times.push_back(ns_since(start) / kBurst);
      wait_for_consumer();
    }
    figures[kFlatMedian] = quantile(times, 0.5);
    times.clear();
    times.reserve(kBurst * kSteppedBursts);
    for (int i = 0; i < kSteppedBursts; ++i) {
      for (std::size_t k = 0; k < kBurst; ++k) {
        times.push_back(timed_push());
      }
      wait_for_consumer();
    }
    figures[kFlatTail] = quantile(times, 0.999);
    times.clear();
    for (std::size_t i = 0; i < kPaced; ++i) {
      for (const std::uint64_t start = now(); ns_since(start) < kPaceNs;) {
      }
      times.push_back(timed_push());
    }
    figures[kPacedMedian] = quantile(times, 0.5);
    figures[kPacedTail] = quantile(times, 0.999);
    wait_for_consumer();
    active_ = false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return figures;
  }
  std::uint64_t dropped() const { return dropped_; }
  std::uint64_t wrong() const { return wrong_; }

 private:
  // Each record was last written some pushes ago, so that copying it does not wait for the stores.
  void push(std::size_t n) {
    std::uint64_t sequence = sequence_;
    for (std::size_t i = 0; i < n; ++i) {
      R& record = records_[sequence % records_.size()];
      if (queue_->push(record)) {
        record.sequence += records_.size();
        ++sequence;
      } else {
        ++dropped_;
      }
    }
    sequence_ = sequence;
  }
  double timed_push() {
    const std::uint64_t start = now();
    push(1);
    return ns_since(start);
  }
  void wait_for_consumer() const {
    while (consumed_.load(std::memory_order_acquire) != sequence_) {
      std::this_thread::yield();
    }
  }
  void consume() {
    pin(1);
    std::uint64_t expected = 0;
    while (!stop_) {
      const std::size_t n = queue_->consume([&](const R& r) {
        wrong_ += r.sequence != expected || r.payload.back() != 7;
        ++expected;
      });
      if (n != 0) {
        consumed_.store(expected, std::memory_order_release);
      }
      if (kind_ == Consumer::kSleeps || !active_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
  }

  std::unique_ptr<Queue> queue_{std::make_unique<Queue>()};
  Consumer kind_;
  // The producer's, the consumer's and the shared: none on the lines of another.
  alignas(128) std::array<R, 16> records_ = [] {
    std::array<R, 16> records{};
    for (std::size_t i = 0; i < records.size(); ++i) {
      records[i].sequence = i;
      records[i].payload.fill(7);
    }
    return records;
  }();
  std::uint64_t sequence_{0}, dropped_{0};
  alignas(128) std::atomic<std::uint64_t> consumed_{0};
  alignas(128) std::atomic<std::uint64_t> wrong_{0};
  alignas(128) std::atomic<bool> stop_{false};
  std::atomic<bool> active_{false};
  std::thread consumer_;
};

// @returns the number of records that arrived wrong or out of order.
template <std::size_t kBytes>
std::uint64_t compare(Consumer kind) {
  using R = Record<kBytes>;
  Run<BlockLogDrained<R>, R> drained(kind);
  Run<BlockLogFlushed<R>, R> flushed(kind);
  Run<Moodycamel<R>, R> moodycamel(kind);
  Run<Boost<R>, R> boost(kind);
  std::array<std::array<std::vector<double>, kFigures>, 4> rounds;
  for (int i = 0; i <= kRounds; ++i) {
    const std::array<Figures, 4> all{drained.round(), flushed.round(), moodycamel.round(),
                                     boost.round()};
    for (std::size_t q = 0; i > 0 && q < all.size(); ++q) {  // the first round warms up
      for (std::size_t f = 0; f < kFigures; ++f) {
        rounds[q][f].push_back(all[q][f]);
      }
    }
  }
  const std::array names{"block log, drain", "block log, flush", "moodycamel", "boost spsc_queue"};
  const std::array dropped{drained.dropped(), flushed.dropped(), moodycamel.dropped(),
                           boost.dropped()};
  for (std::size_t q = 0; q < names.size(); ++q) {
    const auto middle = [&](std::size_t queue, std::size_t f) {
      return quantile(rounds[queue][f], 0.5);
    };
    fmt::print("{:<18}{:<8}{:>6}{:>10.2f}{:>10.0f}{:>10.0f}{:>10.0f}{:>12.2f}{:>12.2f}{:>9}\n",
               names[q], kind == Consumer::kPolls ? "polls" : "sleeps", kBytes, middle(q, 0),
               middle(q, 1), middle(q, 2), middle(q, 3), middle(q, 0) / middle(0, 0),
               middle(q, 2) / middle(0, 2), dropped[q]);
  }
  return drained.wrong() + flushed.wrong() + moodycamel.wrong() + boost.wrong();
}

double clock_cost() {
  std::vector<double> times;
  for (int i = 0; i < 100000; ++i) {
    times.push_back(ns_since(now()));
  }
  return quantile(times, 0.5);
}

}  // namespace

int main() {
  pin(0);
  fmt::print("ns per push; the clock alone reads {:.0f} ns\n", clock_cost());
  fmt::print("{:<18}{:<8}{:>6}{:>10}{:>10}{:>10}{:>10}{:>12}{:>12}{:>9}\n", "queue", "consumer",
             "bytes", "flat med", "p99.9", "paced med", "p99.9", "flat/ours", "paced/ours",
             "dropped");
  const std::uint64_t wrong = compare<64>(Consumer::kPolls) + compare<128>(Consumer::kPolls) +
                              compare<64>(Consumer::kSleeps) + compare<128>(Consumer::kSleeps);
  if (wrong != 0) {
    fmt::print(stderr, "{} records arrived wrong or out of order\n", wrong);
  }
  return wrong == 0 ? 0 : 1;
}
