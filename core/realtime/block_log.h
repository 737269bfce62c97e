#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <type_traits>

#include "core/realtime/cache_line.h"

namespace haptrial::realtime {

/// Carries records from the servo thread to a slower thread without a lock: a list of blocks whose
/// tail belongs to the producer and whose other blocks belong to the consumer.
///
/// Blocks come back in the order in which they were filled, so the list is a circle whose links
/// never change: block b is followed by block (b + 1) mod blocks(). All of it is allocated and
/// touched by the constructor; nothing is allocated after that. A push that finds the whole circle
/// full drops its record and counts it.
///
/// One thread pushes (the producer), one drains (the consumer); each function says which may call.
/// Source: Morris 2006, §6.4.2; what differs and why: docs/algorithms/block-log.md.
template <class Record>
class BlockLog {
  // The test is not is_trivially_copyable: Eigen's fixed-size vectors are plain data with a
  // written-out copy.
  static_assert(std::is_copy_constructible_v<Record> && std::is_trivially_destructible_v<Record>,
                "a record is plain data: slots are overwritten without being destroyed");

 public:
  /// @param block_size  records in a block, at least 1
  /// @param blocks      blocks in the circle, at least 2; the log holds block_size * blocks records
  /// @throws std::invalid_argument naming the size that breaks its bound.
  explicit BlockLog(std::size_t block_size = 1024, std::size_t blocks = 64)
      : block_size_(block_size), capacity_(checked_capacity(block_size, blocks)) {
    const std::size_t bytes = capacity_ * sizeof(Record);
    memory_.reset(static_cast<Record*>(::operator new(bytes, kAlignment)));
    std::memset(static_cast<void*>(memory_.get()), 0, bytes);  // page faults happen here
    producer_.tail_end = block_size_;
  }
  BlockLog(const BlockLog&) = delete;
  BlockLog& operator=(const BlockLog&) = delete;

  /// Appends a copy of the record. Producer; wait-free: no allocation, no waiting for the consumer.
  /// @returns false when no free block remains; the record is then dropped and counted.
  bool push(const Record& record) noexcept {
    std::uint64_t pushed = producer_.pushed.load(std::memory_order_relaxed);
    if (pushed == producer_.tail_end && !open_block()) [[unlikely]] {
      dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return false;
    }
    Record* const slot = memory_.get() + (pushed - producer_.round_start);
    std::construct_at(slot, record);
    producer_.pushed.store(++pushed, std::memory_order_release);
    if (pushed == producer_.tail_end) [[unlikely]] {
      filled_.store(pushed, std::memory_order_release);
    }
    return true;
  }

  /// Gives every full block to f(std::span<const Record>), oldest first, and recycles it. Consumer.
  /// Looks only at what the producer writes once a block, so polling does not slow the producer.
  /// When f throws, the span that it was given stays in the log.
  /// @returns the number of records delivered.
  template <class F>
  std::size_t drain(F&& f) {
    return deliver(filled_.load(std::memory_order_acquire), f);
  }

  /// drain(), and then the records pushed so far into the partial tail. Consumer; the producer may
  /// be running. Every record is delivered once, by whichever call comes first.
  template <class F>
  std::size_t flush(F&& f) {
    return deliver(producer_.pushed.load(std::memory_order_acquire), f);
  }

  /// Records pushed and not yet delivered. Consumer.
  std::size_t size() const noexcept { return pushed() - delivered_; }

  /// Records whose blocks were not given back: at most a block more than size(). Producer.
  std::size_t taken() const noexcept {
    return producer_.pushed.load(std::memory_order_relaxed) -
           recycled_.load(std::memory_order_acquire);
  }

  /// The i-th oldest record that is not yet delivered; i < size(). Consumer; valid until it is
  /// delivered. at() throws std::out_of_range instead of trusting i.
  const Record& operator[](std::size_t i) const noexcept {
    return memory_.get()[(delivered_ + i) % capacity_];
  }
  const Record& at(std::size_t i) const {
    if (i >= size()) {
      throw std::out_of_range("BlockLog::at: no undelivered record has this index");
    }
    return (*this)[i];
  }

  /// Records pushed, and dropped for want of a free block, since construction. Any thread.
  std::uint64_t pushed() const noexcept { return producer_.pushed.load(std::memory_order_acquire); }
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

  std::size_t block_size() const noexcept { return block_size_; }
  std::size_t blocks() const noexcept { return capacity_ / block_size_; }
  std::size_t capacity() const noexcept { return capacity_; }  // records

 private:
  static constexpr std::align_val_t kAlignment{std::max(alignof(Record), kCacheLineBytes)};
  struct Free {
    void operator()(Record* memory) const noexcept { ::operator delete(memory, kAlignment); }
  };

  static std::size_t checked_capacity(std::size_t block_size, std::size_t blocks) {
    if (block_size < 1 || blocks < 2) {
      throw std::invalid_argument("BlockLog: block_size must be at least 1 and blocks at least 2");
    }
    if (block_size > std::numeric_limits<std::size_t>::max() / 2 / sizeof(Record) / blocks) {
      throw std::invalid_argument("BlockLog: block_size * blocks is more than memory can address");
    }
    return block_size * blocks;
  }

  // The tail block is full: goes on to the next one if the consumer has given it back.
  bool open_block() noexcept {
    const std::uint64_t pushed = producer_.tail_end;
    if (pushed - producer_.recycled_seen == capacity_) {
      producer_.recycled_seen = recycled_.load(std::memory_order_acquire);
      if (pushed - producer_.recycled_seen == capacity_) {
        return false;
      }
    }
    if (pushed - producer_.round_start == capacity_) {
      producer_.round_start = pushed;
    }
    producer_.tail_end = pushed + block_size_;
    return true;
  }

  // Delivers up to the record number `end`, a span at most a block long at a time.
  template <class F>
  std::size_t deliver(std::uint64_t end, F& f) {
    const std::uint64_t begin = delivered_;
    while (delivered_ < end) {
      const std::size_t in_block = delivered_ % block_size_;
      const std::size_t count = std::min<std::uint64_t>(block_size_ - in_block, end - delivered_);
      f(std::span<const Record>(&(*this)[0], count));
      delivered_ += count;
      if (in_block + count == block_size_) {
        recycled_.store(delivered_, std::memory_order_release);
      }
    }
    return delivered_ - begin;
  }

  std::size_t block_size_;
  std::size_t capacity_;
  std::unique_ptr<Record[], Free> memory_;

  // Each group below is written by one thread and has its cache lines to itself.
  struct alignas(kSeparation) Producer {
    std::atomic<std::uint64_t> pushed{0};  // published by every push; read by flush()
    std::uint64_t tail_end{0};             // number of the record after the tail block
    std::uint64_t round_start{0};          // number of the record in the first slot of the circle
    std::uint64_t recycled_seen{0};        // the last that was read of recycled_
  };
  Producer producer_;
  alignas(kSeparation) std::atomic<std::uint64_t> filled_{0};  // records in full blocks
  alignas(kSeparation) std::atomic<std::uint64_t> dropped_{0};
  alignas(kSeparation) std::uint64_t delivered_{0};              // consumer's
  alignas(kSeparation) std::atomic<std::uint64_t> recycled_{0};  // records in blocks given back
};

}  // namespace haptrial::realtime
