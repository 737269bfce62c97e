#pragma once

#include <string>

#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

/// The room in which sessions run: where their files are backed up, and who helps.
struct Room {
  std::string backup;   // folder, an absolute path; empty: none
  std::string contact;  // empty: not stated
  std::string phone;    // empty: not stated
};

/// The keys of [room].
const Schema<Room>& room_schema();

/// The room of a definition that is good; empty texts if it has no [room]. Any thread.
/// @param root  of the definition, of which nothing has been read (Definition::root())
Room room_of(Table root);

}  // namespace haptrial::protocols
