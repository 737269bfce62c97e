#include "core/record/read/imported.h"

#include "core/record/read/session_reader.h"

namespace haptrial::record {

std::string imported_from(const SessionReader& reader) {
  for (const EventRow& event : reader.events()) {
    if (event.kind == kImportedEvent) {
      return event.text;
    }
  }
  return "";
}

}  // namespace haptrial::record
