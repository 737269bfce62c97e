#include "core/tutoring/tick_message.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace haptrial::tutoring {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

/// Every member in turn, for both ways.
template <class Message, class Field>
void each_field(Message& m, Field field) {
  field(m.sequence);
  field(m.sent_ns);
  field(m.echo_ns);
  field(m.held_ns);
  for (auto* vector : {&m.position, &m.velocity, &m.force, &m.stimulus}) {
    for (int axis = 0; axis < 3; ++axis) {
      field((*vector)[axis]);
    }
  }
  field(m.energy);
  field(m.lead);
  field(m.world);
  field(m.buttons);
  field(m.flags);
  field(m.turn.pass);
  field(m.turn.with);
  field(m.turn.item);
  field(m.turn.phase);
  field(m.turn.last_done);
}

/// Calls `field` for each field that follows if there is a stream.
template <class Part, class Field>
void each_field_of_stream(Part& part, Field field) {
  field(part.number);
  field(part.heard);
  field(part.beyond);
  field(part.size);
  field(part.bytes);
}

constexpr std::uint32_t kKnownFlags = kEngaged | kStop | kFault | kClaim | kOver | kLeft;

bool makes_sense(const TickMessage& m) noexcept {
  return m.position.allFinite() && m.velocity.allFinite() && m.force.allFinite() &&
         m.stimulus.allFinite() && std::isfinite(m.energy) && m.lead >= 0.0 && m.lead <= 1.0 &&
         (m.flags & ~kKnownFlags) == 0 && m.turn.phase <= TurnPhase::kBroken &&
         m.turn.last_done <= 1 && m.stream.size <= StreamPart::kMost;
}

}  // namespace

TickBytes encode(const TickMessage& message) noexcept {
  const bool streams = message.stream.number != 0 || message.stream.heard != 0 ||
                       message.stream.beyond != StreamPart{}.beyond;
  TickBytes bytes(streams ? kStreamTickBytes : kTickBytes);
  std::size_t at = 0;
  const auto put = [&](const auto& value) {
    std::memcpy(bytes.data() + at, &value, sizeof(value));
    at += sizeof(value);
  };
  each_field(message, put);
  if (streams) {
    each_field_of_stream(message.stream, put);
  }
  return bytes;
}

std::optional<TickMessage> decode(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != kTickBytes && bytes.size() != kStreamTickBytes) {
    return std::nullopt;
  }
  TickMessage message;
  std::size_t at = 0;
  const auto take = [&](auto& value) {
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    at += sizeof(value);
  };
  each_field(message, take);
  if (bytes.size() == kStreamTickBytes) {
    each_field_of_stream(message.stream, take);
  }
  return makes_sense(message) ? std::optional(message) : std::nullopt;
}

}  // namespace haptrial::tutoring
