#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/definition/given_values.h"
#include "core/base/definition/removed_keys.h"
#include "core/base/definition/toml_text_internal.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::edited_text {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A value, or a table, of a definition: its path as GivenKey has it.
using Flat = std::map<std::string, std::string>;

std::string written(const toml::node& node) {
  std::ostringstream out;
  node.visit([&](const auto& value) {
    if constexpr (toml::is_string<decltype(value)>) {
      out << '"';
      for (const char c : value.get()) {
        out << (c == '\n' ? "\\n" : c == '"' ? "\\\"" : c == '\\' ? "\\\\" : std::string(1, c));
      }
      out << '"';
    } else {
      out << value;
    }
  });
  return out.str();
}

void flatten(const toml::node& node, const std::string& path, Flat& into) {
  const std::string prefix = path.empty() ? "" : path + ".";
  const toml::array* array = node.as_array();
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      flatten(value, prefix + std::string(key.str()), into);
    }
  } else if (array != nullptr && !array->empty() && array->front().is_table()) {
    for (std::size_t i = 0; i < array->size(); ++i) {
      into[prefix + std::to_string(i + 1)] = "entry";
      flatten(*array->get(i), prefix + std::to_string(i + 1), into);
    }
  } else {
    std::string all;
    if (array != nullptr) {
      for (const toml::node& each : *array) {
        all += (all.empty() ? "" : ", ") + (each.is_array() ? std::string("[]") : written(each));
      }
      all = "[" + all + "]";
    }
    into[path] = array != nullptr ? all : written(node);
  }
}

Flat values_of(const std::string& text) {
  Flat all;
  flatten(parse_toml(text, "edited.toml"), "", all);
  return all;
}

/// Comments that begin a line, and those behind a value on one line.
std::vector<std::string> comments_of(const std::string& text) {
  std::vector<std::string> found;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    char quote = '\0';
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (quote != '\0') {
        quote = line[i] == quote ? '\0' : quote;
      } else if (line[i] == '"' || line[i] == '\'') {
        quote = line[i];
      } else if (line[i] == '#') {
        found.push_back(line.substr(i));
        break;
      }
    }
  }
  return found;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// Lines of one text that the other lacks, counting lines that occur more than once.
std::size_t lines_without(const std::string& one, const std::string& other) {
  std::multiset<std::string> left;
  for (const std::string& line : lines_of(other)) {
    left.insert(line);
  }
  std::size_t missing = 0;
  for (const std::string& line : lines_of(one)) {
    const auto found = left.find(line);
    if (found == left.end()) {
      ++missing;
    } else {
      left.erase(found);
    }
  }
  return missing;
}

/// The bytes before and after the one place at which two texts part are the same in both.
bool differ_in_one_place(const std::string& a, const std::string& b, std::size_t most) {
  const auto first = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  const auto head = static_cast<std::size_t>(first.first - a.begin());
  std::size_t tail = 0;
  while (tail < std::min(a.size(), b.size()) - head &&
         a[a.size() - 1 - tail] == b[b.size() - 1 - tail]) {
    ++tail;
  }
  return a.size() - head - tail <= most && b.size() - head - tail <= most;
}

std::string text_of_key(const std::string& path) {
  return path.substr(path.rfind('.') == std::string::npos ? 0 : path.rfind('.') + 1);
}

/// The paths and values that shipped definitions give to keys with the same name.
using Pool = std::vector<std::pair<std::string, std::string>>;

class Editor {
 public:
  Editor(std::string text, const Pool& pool, std::uint32_t seed)
      : text_(std::move(text)), pool_(pool), random_(seed) {}

  void edit() {
    const Flat before = values_of(text_);
    const auto kind = before.empty() ? 3 : random_() % 8;
    if (kind < 2) {
      set(before);
    } else if (kind == 2) {
      remove(before);
    } else if (kind < 7) {
      add(before);
    } else {
      add_entry(before);
    }
  }
  const std::string& text() const { return text_; }
  int edits() const { return edits_; }

 private:
  template <class Container>
  const auto& any(const Container& of) {
    return *std::next(of.begin(), static_cast<std::ptrdiff_t>(random_() % of.size()));
  }

  void expect(const std::string& after, const Flat& intended, const std::string& what) {
    SCOPED_TRACE(what);
    ASSERT_EQ(stated(values_of(after)), stated(intended)) << after;
    ASSERT_EQ(lost_comments(after), std::vector<std::string>());
    text_ = after;
    ++edits_;
  }

  /// A list in brackets is empty when its last entry is removed.
  static Flat stated(Flat all) {
    std::erase_if(all, [](const auto& each) { return each.second == "[]"; });
    return all;
  }

  std::vector<std::string> lost_comments(const std::string& after) const {
    const auto was = comments_of(text_);
    const auto is = comments_of(after);
    return was == is ? std::vector<std::string>() : was;
  }

  void set(const Flat& before) {
    const auto [path, old] = any(before);
    if (old == "entry" || text_of_block(path)) {
      return;
    }
    const GivenKey given{path, any(pool_).second};
    const std::string after = with_values(text_, "edited.toml", std::span(&given, 1));
    Flat intended = before;
    intended[path] = given.value;
    ASSERT_TRUE(differ_in_one_place(text_, after, std::max(old.size(), given.value.size()) + 200));
    expect(after, intended, "set " + path + " = " + given.value);
  }

  void add(const Flat& before) {
    auto [path, value] = any(pool_);
    if (random_() % 2 == 0 && !before.empty()) {  // into a table of the text
      path = any(before).first;
      path = (path.rfind('.') == std::string::npos ? "" : path.substr(0, path.rfind('.') + 1)) +
             "added_" + std::to_string(edits_);
    }
    const auto taken = [&](const auto& each) {
      return each.first == path || each.first.starts_with(path + ".");
    };
    if (std::any_of(before.begin(), before.end(), taken)) {
      return;
    }
    const GivenKey given{path, value};
    std::string after;
    try {
      after = with_values(text_, "edited.toml", std::span(&given, 1));
    } catch (const InputError&) {  // the path leads through a value or an entry that is not there
      return;
    }
    Flat intended = before;
    intended[path] = value;
    ASSERT_EQ(lines_without(text_, after), inline_lines(after)) << path;
    expect(after, intended, "add " + path + " = " + value);
  }

  /// A key within braces changes its line; any other adds lines alone.
  std::size_t inline_lines(const std::string& after) const {
    return lines_of(after).size() == lines_of(text_).size() ? 1 : 0;
  }

  void remove(const Flat& before) {
    std::string path = any(before).first;
    if (random_() % 4 == 0 && path.find('.') != std::string::npos) {  // its table
      path = path.substr(0, path.rfind('.'));
    }
    if (text_of_block(path)) {
      return;
    }
    std::string after;
    try {
      after = without_key(text_, "edited.toml", path);
    } catch (const InputError&) {  // keys with dots within braces
      return;
    }
    Flat intended = before;
    std::erase_if(intended, [&](const auto& each) {
      return each.first == path || each.first.starts_with(path + ".");
    });
    const auto entry = before.find(path);
    expect(after, renumbered(intended, path, entry != before.end() && entry->second == "entry"),
           "remove " + path);
  }

  /// Entries behind a removed one move up by one.
  static Flat renumbered(const Flat& all, const std::string& path, bool entry) {
    if (!entry) {
      return all;
    }
    const std::string array = path.substr(0, path.rfind('.') + 1);
    const int removed = std::stoi(text_of_key(path));
    Flat moved;
    for (const auto& [key, value] : all) {
      std::string name = key;
      if (key.starts_with(array)) {
        const std::size_t end = std::min(key.find('.', array.size()), key.size());
        const int number = std::stoi(key.substr(array.size(), end - array.size()));
        name = array + std::to_string(number > removed ? number - 1 : number) + key.substr(end);
      }
      moved[name] = value;
    }
    return moved;
  }

  void add_entry(const Flat& before) {
    std::vector<std::string> entries;
    for (const auto& [path, value] : before) {
      if (value == "entry") {
        entries.push_back(path.substr(0, path.rfind('.')));
      }
    }
    if (entries.empty()) {
      return;
    }
    const std::string array = any(entries);
    const std::string after = with_new_entry(text_, "edited.toml", array);
    Flat intended = before;
    int count = 1;
    while (before.contains(array + "." + std::to_string(count))) {
      ++count;
    }
    intended[array + "." + std::to_string(count)] = "entry";
    ASSERT_LE(lines_without(text_, after), 1u);  // an array in brackets changes its line
    expect(after, intended, "add an entry to " + array);
  }

  /// Lists over several lines may hold comments, which go with them.
  static bool has_block(const toml::node& node) {
    const toml::array* array = node.as_array();
    const toml::table* table = node.as_table();
    if (table != nullptr) {
      return std::any_of(table->begin(), table->end(),
                         [](const auto& each) { return has_block(each.second); });
    }
    if (array != nullptr && !array->empty() && array->front().is_table() &&
        !array->front().as_table()->is_inline()) {
      return std::any_of(array->begin(), array->end(), has_block);
    }
    return node.source().begin.line != node.source().end.line;
  }

  bool text_of_block(const std::string& path) const {
    const auto root = parse_toml(text_, "edited.toml");
    const toml::node* node = &root;
    std::istringstream parts(path);
    for (std::string part; node != nullptr && std::getline(parts, part, '.');) {
      node = node->is_table() ? node->as_table()->get(part)
                              : node->as_array()->get(std::stoul(part) - 1);
    }
    return node == nullptr || has_block(*node);
  }

  std::string text_;
  const Pool& pool_;
  std::mt19937 random_;
  int edits_{0};
};

std::vector<fs::path> shipped_definitions() {
  std::vector<fs::path> files;
  for (const auto& each : fs::directory_iterator(HAPTRIAL_SOURCE_DIR "/experiments")) {
    if (each.path().extension() == ".toml") {
      files.push_back(each.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(EditedText, ShippedDefinitionsSurviveRandomEdits) {
  const std::vector<fs::path> files = shipped_definitions();
  ASSERT_GT(files.size(), 10u);
  Pool pool;
  for (const fs::path& file : files) {
    for (const auto& [path, value] : values_of(file_text(file))) {
      if (value != "entry" && value.find("[]") == std::string::npos && value.find('.') != 0) {
        pool.emplace_back(path, value);
      }
    }
  }
  std::uint32_t seed = 1;
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.string());
    Editor editor(file_text(file), pool, seed++);
    for (int tries = 0; editor.edits() < 200; ++tries) {
      ASSERT_LT(tries, 5000);
      editor.edit();
      if (HasFatalFailure()) {
        return;
      }
    }
  }
}

constexpr const char* kText = R"(# a heading
name = "walls"  # its name

[observer]
lapse.median = 0.02
noise = { spread = 0.3, median = 1 }  # in N

# the easy one
[[blocks]]
name = "easy"
[blocks.procedure.steps]
up = 1

# the hard one
[[blocks]]
name = "hard"
shift = 0.5
)";

std::string given(const std::string& key, const std::string& value) {
  const GivenKey one{key, value};
  return with_values(kText, "a.toml", std::span(&one, 1));
}

std::string without(const std::string& key) { return without_key(kText, "a.toml", key); }

TEST(EditedText, NewKeysStandBelowThoseOfTheirTable) {
  EXPECT_THAT(given("seed", "3"), HasSubstr("# its name\nseed = 3\n\n[observer]"));
  EXPECT_THAT(given("observer.lapse.spread", "2"), HasSubstr("in N\nlapse.spread = 2\n\n# the"));
  EXPECT_THAT(given("observer.noise.low", "2"), HasSubstr("median = 1, low = 2 }  # in N"));
  EXPECT_THAT(given("blocks.easy.shift", "2"), HasSubstr("\"easy\"\nshift = 2\n[blocks.proc"));
  EXPECT_THAT(given("blocks.hard.procedure.kind", "2"), HasSubstr("0.5\nprocedure.kind = 2\n"));
  EXPECT_THAT(given("blocks.easy.procedure.kind", "2"),
              HasSubstr("\"easy\"\n[blocks.procedure]\nkind = 2\n\n[blocks.procedure.steps]"));
}

TEST(EditedText, RemovedKeysLeaveCommentsAndOtherKeys) {
  EXPECT_THAT(without("name"), HasSubstr("# a heading\n# its name\n\n[observer]"));
  EXPECT_THAT(without("observer.noise.spread"), HasSubstr("noise = { median = 1 }  # in N"));
  EXPECT_THAT(without("observer.noise.median"), HasSubstr("noise = { spread = 0.3 }  # in N"));
  EXPECT_THAT(without("observer"), HasSubstr("# its name\n\n# in N\n\n# the easy one\n"));
  EXPECT_THAT(without("blocks.easy"), HasSubstr("# the easy one\n\n# the hard one\n[[blocks]]"));
}

TEST(EditedText, AQuoteInTheNameOfATableHidesNoOtherTable) {
  constexpr const char* kPages =
      "[pages.\"at 5\\\" off\"]\ntext = \"a\"\n\n[pages.hand]\ntext = \"b\"\n\n[envelope]\n"
      "max_force = 3.0\n";
  EXPECT_EQ(without_key(kPages, "a.toml", "pages.at 5\" off"),
            "\n[pages.hand]\ntext = \"b\"\n\n[envelope]\nmax_force = 3.0\n");
}

TEST(EditedText, EntriesAreAddedBelowTheLast) {
  EXPECT_EQ(with_new_entry(kText, "a.toml", "blocks"), std::string(kText) + "\n[[blocks]]\n");
  EXPECT_THAT(with_new_entry(kText, "a.toml", "blocks.easy.cues"),
              HasSubstr("up = 1\n\n[[blocks.cues]]\n\n# the hard one"));
  EXPECT_EQ(with_new_entry("a = [{ x = 1 }]", "a.toml", "a"), "a = [{ x = 1 }, {}]");
}

TEST(EditedText, RefusesWhatIsNoEditOfOneKey) {
  EXPECT_THROW(given("observer.x", "1\nother = 2"), InputError);
  EXPECT_THROW(given("observer.x", "1 # why"), InputError);
  EXPECT_THROW(given("observer.x", "two words"), InputError);
  EXPECT_THROW(given("observer.x", ""), InputError);
  EXPECT_THROW(without("observer.none"), InputError);
  EXPECT_THROW(with_new_entry(kText, "a.toml", "observer"), InputError);
}

TEST(EditedText, KeepsMarksAndLineEndings) {
  const GivenKey one{"a", "22"};
  EXPECT_EQ(with_values("\ufeffa = 1\r\nb = 2\r\n", "a.toml", std::span(&one, 1)),
            "\ufeffa = 22\r\nb = 2\r\n");
  EXPECT_EQ(without_key("\ufeffa = 1\r\nb = 2\r\n", "a.toml", "b"), "\ufeffa = 1\r\n");
}

}  // namespace
}  // namespace haptrial::edited_text
