#include "core/record/rows/event_parts.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "core/record/table/check_text.h"
#include "core/record/table/schema.h"

namespace haptrial::record {

std::vector<EventPart> event_parts(const EventRow& event) {
  std::vector<EventPart> parts;
  std::string_view rest = event.text;
  check_text(event.kind, kKindBytes, "event kind");  // before the first part is put anywhere
  check_text(rest, rest.size(), "event text");
  do {
    std::size_t size = std::min(rest.size(), kTextBytes);
    // A cut never falls within a UTF-8 character (at most three continuation bytes back).
    if (size < rest.size()) {
      std::size_t cut = size;
      while (cut + 4 > size && (static_cast<unsigned char>(rest[cut]) & 0xC0u) == 0x80u) {
        --cut;
      }
      if ((static_cast<unsigned char>(rest[cut]) & 0xC0u) != 0x80u) {
        size = cut;
      }
    }
    parts.push_back({{event.time_ns, event.kind, std::string(rest.substr(0, size))},
                     static_cast<std::int32_t>(parts.size())});
    rest.remove_prefix(size);
  } while (!rest.empty());
  return parts;
}

std::vector<EventRow> joined_events(std::vector<EventPart> parts) {
  std::vector<EventRow> events;
  for (EventPart& part : parts) {
    if (part.part > 0 && !events.empty()) {
      events.back().text += part.row.text;
    } else {
      events.push_back(std::move(part.row));
    }
  }
  return events;
}

}  // namespace haptrial::record
