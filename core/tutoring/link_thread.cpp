#include "core/tutoring/link_thread.h"

#include <poll.h>
#include <sys/socket.h>

#include <chrono>
#include <ctime>
#include <utility>

namespace haptrial::tutoring {

std::int64_t link_clock_ns() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

LinkThread::LinkThread(EstablishedLink met)
    : met_(std::move(met)),
      sealer_(met_.keys),
      opener_(met_.keys),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void LinkThread::run(const std::stop_token& stop) noexcept {
  constexpr timespec kLook{0, 250'000};
  while (!stop.stop_requested()) {
    pollfd watched{met_.datagrams.get(), POLLIN, 0};
    ::ppoll(&watched, 1, &kLook, nullptr);
    take_in();
    send_out();
    publish();
  }
  send_out();  // what was said last, as that a session is over
  publish();
}

/// A limited number at a time: a flood must not keep own messages from leaving.
void LinkThread::take_in() noexcept {
  constexpr int kAtOnce = 256;
  std::array<unsigned char, kMostSealedBytes + 1> buffer;  // one more shows what is too long
  for (int i = 0; i < kAtOnce; ++i) {
    Address from;
    from.size = sizeof(from.storage);
    const ssize_t got = ::recvfrom(met_.datagrams.get(), buffer.data(), buffer.size(), 0,
                                   reinterpret_cast<sockaddr*>(&from.storage), &from.size);
    if (got < 0) {
      return;
    }
    const auto message = opener_.open({buffer.data(), static_cast<std::size_t>(got)});
    if (message) {
      if (met_.follows) {
        met_.other = from;
      }
      if (heard_.load(std::memory_order_acquire)) {
        in_.push({*message, link_clock_ns()});
      }
    }
  }
}

void LinkThread::send_out() noexcept {
  out_.flush([this](std::span<const TickMessage> messages) {
    for (const TickMessage& message : messages) {
      const SealedBytes bytes = sealer_.seal(message);
      const ssize_t sent =
          ::sendto(met_.datagrams.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
                   reinterpret_cast<const sockaddr*>(&met_.other.storage), met_.other.size);
      ++(sent == static_cast<ssize_t>(bytes.size()) ? own_.sent : own_.failed);
    }
  });
}

void LinkThread::publish() noexcept {
  const Opener::Counts& c = opener_.counts();
  sent_.store(own_.sent, std::memory_order_relaxed);
  failed_.store(own_.failed, std::memory_order_relaxed);
  accepted_.store(c.accepted, std::memory_order_relaxed);
  foreign_.store(c.foreign, std::memory_order_relaxed);
  forged_.store(c.forged, std::memory_order_relaxed);
  repeated_.store(c.repeated, std::memory_order_relaxed);
}

std::int64_t LinkThread::tick() noexcept {
  heard_.store(true, std::memory_order_release);
  return link_clock_ns();
}

void LinkThread::receive(Listener& listener) noexcept {
  in_.flush([&listener](std::span<const Arrived> all) {
    for (const Arrived& arrived : all) {
      listener.hear(arrived);
    }
  });
}

/// Several times, since any may be lost on the way.
void LinkThread::close(const TickMessage& last) noexcept {
  constexpr int kTimes = 20;
  constexpr std::chrono::milliseconds kBetween(5);
  TickMessage message = last;
  for (int i = 0; i < kTimes; ++i) {
    message.sent_ns = link_clock_ns();
    out_.push(message);
    ++message.sequence;
    std::this_thread::sleep_for(kBetween);
  }
}

WireCounts LinkThread::counts() const noexcept {
  return {sent_.load(std::memory_order_relaxed),
          accepted_.load(std::memory_order_relaxed),
          foreign_.load(std::memory_order_relaxed),
          forged_.load(std::memory_order_relaxed),
          repeated_.load(std::memory_order_relaxed),
          failed_.load(std::memory_order_relaxed),
          out_.dropped() + in_.dropped()};
}

}  // namespace haptrial::tutoring
