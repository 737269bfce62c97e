#include "core/base/definition/stated_keys.h"

#include <algorithm>
#include <utility>

#include "core/base/definition/text_places_internal.h"
#include "core/base/definition/toml_text_internal.h"

namespace haptrial {
namespace {

class KeyLister {
 public:
  explicit KeyLister(std::string_view text) : text_(text) {}

  void list(const toml::table& table, const std::string& path) {
    for (const auto& [key, value] : table) {
      const std::string name(key.str());
      if (name.find('.') == std::string::npos) {
        add(path.empty() ? name : path + "." + name, key.source().begin, value);
      }
    }
  }
  std::vector<StatedKey> keys;

 private:
  void add(const std::string& path, toml::source_position at, const toml::node& value) {
    if (const toml::table* table = value.as_table()) {
      at = table->source().begin;
      keys.push_back({path, "", at.line, at.column, true});
      list(*table, path);
    } else if (const toml::array* array = value.as_array(); array && has_headers(*array)) {
      list_entries(*array, path);
    } else {
      const std::size_t begin = byte_of(text_, value.source().begin);
      const std::size_t end = byte_of(text_, value.source().end);
      keys.push_back(
          {path, std::string(text_.substr(begin, end - begin)), at.line, at.column, false});
    }
  }

  /// Entries by their names, or by their numbers where names do not tell them apart.
  void list_entries(const toml::array& array, const std::string& path) {
    const auto name_of = [](const toml::node& entry) {
      return (*entry.as_table())["name"].value_or(std::string());
    };
    for (std::size_t i = 0; i < array.size(); ++i) {
      const std::string name = name_of(array[i]);
      const auto same = std::count_if(array.begin(), array.end(), [&](const toml::node& each) {
        return name_of(each) == name;
      });
      const bool named = !name.empty() && same == 1 && name.find('.') == std::string::npos;
      add(path + "." + (named ? name : std::to_string(i + 1)), {}, array[i]);
    }
  }

  std::string_view text_;
};

}  // namespace

std::vector<StatedKey> stated_keys(std::string_view text, std::string_view file_name) {
  KeyLister lister(text);
  const toml::table root = parse_toml(text, file_name);
  lister.list(root, "");
  std::ranges::stable_sort(lister.keys, {},
                           [](const StatedKey& each) { return std::pair(each.line, each.column); });
  return std::move(lister.keys);
}

}  // namespace haptrial
