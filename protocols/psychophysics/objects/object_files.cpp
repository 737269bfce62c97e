#include "protocols/psychophysics/objects/object_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"

namespace haptrial::protocols {

std::vector<record::ObjectFileRow> object_files(const std::vector<TrialObject>& objects) {
  std::vector<record::ObjectFileRow> rows;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const TrialObject& object = objects[i];
    if (!object.file.empty()) {
      rows.push_back({static_cast<std::int32_t>(i), object.name, object.file.string(),
                      object.file_bytes, object.file_checksum});
    }
    if (!object.constants_file.empty()) {
      rows.push_back({static_cast<std::int32_t>(i), object.name + ".calibrated",
                      object.constants_file.string(), object.constants_bytes,
                      object.constants_checksum});
    }
  }
  return rows;
}

void check_object_files(const record::SessionReader& recorded,
                        const std::vector<TrialObject>& objects, std::string_view to) {
  const std::vector<record::ObjectFileRow> now = object_files(objects);
  for (const record::ObjectFileRow& before : recorded.rows<record::ObjectFileRow>()) {
    const auto same = std::ranges::find(now, before.name, &record::ObjectFileRow::name);
    if (same != now.end() && (same->bytes != before.bytes || same->checksum != before.checksum)) {
      throw InputError(fmt::format(
          "{}: was recorded with another file of objects.{}: '{}' has the checksum {:016x}, the "
          "recording {:016x}; {} it with the same file",
          recorded.path().string(), before.name, same->file, same->checksum, before.checksum, to));
    }
  }
}

}  // namespace haptrial::protocols
