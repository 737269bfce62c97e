#include "protocols/definition/room.h"

#include <filesystem>

#include "core/base/definition/schema.h"

namespace haptrial::protocols {

const Schema<Room>& room_schema() {
  static const auto schema =
      Schema<Room>()
          .text("backup", &Room::backup,
                "Folder, as an absolute path, into which the file of an ended session is copied: "
                "BACKUP/NAME OF THE STUDY/P01.h5")
          .otherwise("none")
          .text("contact", &Room::contact,
                "Who helps in an emergency, for the emergency card; session files keep it")
          .otherwise("none")
          .text("phone", &Room::phone,
                "Number to call in an emergency, for the emergency card; session files keep it")
          .otherwise("none")
          .check([](Table& table, Room& room) {
            if (!room.backup.empty() && !std::filesystem::path(room.backup).is_absolute()) {
              table.reject("backup", "'" + room.backup + "'",
                           "a path that begins with /, since several studies may use a lab file");
            }
          });
  return schema;
}

Room room_of(Table root) {
  if (!root.has("room")) {
    return {};
  }
  Table table = root.table("room");
  return room_schema().read(table);
}

}  // namespace haptrial::protocols
