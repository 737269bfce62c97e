#pragma once

#include <string>

namespace haptrial {
template <class T>
class Schema;
class Table;
}  // namespace haptrial

namespace haptrial::protocols {

struct Definition;

/// The room in which sessions run: where their files are backed up, and who helps.
struct Room {
  std::string backup;   // folder, an absolute path; empty: none
  std::string contact;  // empty: not stated
  std::string phone;    // empty: not stated
};

/// The keys of [room].
const Schema<Room>& room_schema();

/// The room of a definition, which has been read; empty texts if it has no [room]. Any thread.
Room room_of(const Definition& definition);

}  // namespace haptrial::protocols
