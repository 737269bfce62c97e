#include "core/record/recovery/isolated_info.h"

#include <string>
#include <vector>

#include "core/record/hdf5/session_info.h"
#include "core/record/read/isolated.h"

namespace haptrial::record {

std::optional<SessionInfo> isolated_info(const std::filesystem::path& file) {
  // Every field as name, NUL, value, NUL.
  const auto text = in_a_process_of_its_own(0, [&] {
    std::string all;
    for (const EventRow& row : info_rows(get_info(h5::open_file(file)))) {
      all += row.kind + '\0' + row.text + '\0';
    }
    return all;
  });
  if (!text) {
    return std::nullopt;
  }
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text->size(); at = text->find('\0', at) + 1) {
    words.emplace_back(text->c_str() + at);
  }
  std::vector<EventRow> rows;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    rows.push_back({0, words[i], words[i + 1]});
  }
  return info_of(rows);
}

}  // namespace haptrial::record
