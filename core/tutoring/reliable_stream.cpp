#include "core/tutoring/reliable_stream.h"

#include <algorithm>
#include <bit>

namespace haptrial::tutoring {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kReordering = 20 * kMillisecond;  // by which one may overtake another
constexpr std::int64_t kPatience = 100 * kMillisecond;   // before a round trip is known

}  // namespace

ReliableStream::ReliableStream() : out_(kSpan), in_(kSpan) {}

void ReliableStream::note_heard(std::uint64_t number) noexcept {
  if (number > heard_ && number <= given_) {
    SentChunk& given = out_[slot(number)];
    newest_heard_ = given.heard ? newest_heard_ : std::max(newest_heard_, given.sent_ns);
    given.heard = true;
  }
}

void ReliableStream::hear(const StreamPart& part) noexcept {
  for (std::uint64_t number = heard_ + 1; number <= std::min(part.heard, given_); ++number) {
    note_heard(number);
  }
  for (std::size_t word = 0; word < part.beyond.size(); ++word) {
    for (std::uint64_t bits = part.beyond[word]; bits != 0; bits &= bits - 1) {
      note_heard(part.heard + 1 + 64 * word + static_cast<std::uint64_t>(std::countr_zero(bits)));
    }
  }
  while (heard_ < given_ && out_[slot(heard_ + 1)].heard) {
    ++heard_;
  }
  if (part.number == 0) {
    return;
  }
  answer_due_ = true;  // also where it came before: the answer was lost
  if (part.number > taken_ && part.number <= taken_ + kSpan) {
    ReceivedChunk& come = in_[slot(part.number)];
    come.chunk.size = part.size;
    std::copy_n(part.bytes.begin(), part.size, come.chunk.bytes.begin());
    come.here = true;
  }
}

void ReliableStream::deliver(ReliablePayload& payload) noexcept {
  for (ReceivedChunk* come = &in_[slot(taken_ + 1)]; come->here; come = &in_[slot(taken_ + 1)]) {
    come->here = false;
    ++taken_;
    payload.take({come->chunk.bytes.data(), come->chunk.size});
  }
}

/// The first that is overdue, or that a later one has overtaken by more than messages do.
std::uint64_t ReliableStream::missing(std::int64_t now_ns,
                                      std::int64_t round_trip_ns) const noexcept {
  const std::int64_t overdue = round_trip_ns < 0 ? kPatience : 2 * round_trip_ns + kReordering;
  for (std::uint64_t number = heard_ + 1; number <= given_; ++number) {
    const SentChunk& given = out_[slot(number)];
    if (!given.heard &&
        (now_ns - given.sent_ns > overdue || newest_heard_ - given.sent_ns > kReordering)) {
      return number;
    }
  }
  return 0;
}

std::uint64_t ReliableStream::next(ReliablePayload& payload) noexcept {
  if (given_ - heard_ >= kSpan) {
    return 0;
  }
  SentChunk& given = out_[slot(given_ + 1)];
  const std::size_t size = payload.give(given.chunk.bytes);
  if (size == 0) {
    return 0;
  }
  given.chunk.size = static_cast<std::uint16_t>(size);
  given.heard = false;
  return ++given_;
}

bool ReliableStream::wants(ReliablePayload& payload, std::int64_t now_ns,
                           std::int64_t round_trip_ns) noexcept {
  chosen_ = missing(now_ns, round_trip_ns);
  again_ += chosen_ != 0 ? 1 : 0;
  chosen_ = chosen_ != 0 ? chosen_ : next(payload);
  return chosen_ != 0 || answer_due_;
}

void ReliableStream::fill(StreamPart& part, std::int64_t now_ns) noexcept {
  part.heard = taken_;
  part.beyond.fill(0);
  for (std::uint64_t i = 0; i < kSpan; ++i) {
    part.beyond[i / 64] |= std::uint64_t{in_[slot(taken_ + 1 + i)].here} << (i % 64);
  }
  answer_due_ = false;
  part.number = chosen_;
  part.size = 0;
  if (chosen_ != 0) {
    SentChunk& given = out_[slot(chosen_)];
    given.sent_ns = now_ns;
    part.size = given.chunk.size;
    std::copy_n(given.chunk.bytes.begin(), part.size, part.bytes.begin());
    chosen_ = 0;
  }
}

}  // namespace haptrial::tutoring
