#include "core/scene/read/read_region.h"

#include <algorithm>
#include <utility>

#include "core/base/definition/table.h"
#include "core/scene/read/shape_kinds.h"

namespace haptrial::scene {

Region read_region(Table& table, std::string name) {
  table.describe({"type", "Shape of the region", "", true});
  std::vector<std::string> words;
  for (const KindOfShape& kind : kinds_of_shape()) {
    words.push_back(kind.word);
  }
  const std::string word = table.choice("type", words);
  if (table.whole_text("type") != word) {
    for (const std::string& key : table.keys()) {
      table.leave(key);
    }
    return {std::move(name), {}};
  }
  return {std::move(name),
          std::ranges::find(kinds_of_shape(), word, &KindOfShape::word)->read(table)};
}

std::vector<Region> read_regions(Table& regions) {
  std::vector<Region> found;
  for (const std::string& name : regions.keys()) {
    Table table = regions.table(name);
    found.push_back(read_region(table, name));
  }
  return found;
}

}  // namespace haptrial::scene
