#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial {
namespace {

/// Reads every key that is there in every way, and some that are not.
void read_all(Table& table, int depth) {
  for (const std::string& key : table.keys()) {
    table.number(key, kPositive, "m");
    table.integer(key, 1, 5);
    table.boolean(key);
    table.text(key);
    table.choice(key, {"a", "b"});
    table.numbers(key, kFraction, "N");
    table.texts(key);
    Table inner = table.table(key);
    if (depth < 300) {
      read_all(inner, depth + 1);
    }
  }
  table.number("absent", kPositive, "");
}

/// One change such as an editor or a bad disk makes.
void damage(std::string& text, RandomStream& random) {
  static const std::string kSigns = "[]{}\"'=.,#\n\r\t \\-+_0e\xff\xc3";
  const auto anywhere = [&] { return random.below(text.size() + 1); };
  const std::size_t at = anywhere();
  const std::size_t length = random.below(20);
  switch (random.below(5)) {
    case 0:
      text.erase(at, length);
      break;
    case 1:
      text.insert(at, 1, kSigns[random.below(kSigns.size())]);
      break;
    case 2:
      text.insert(at, text.substr(anywhere(), length));
      break;
    case 3:
      if (at < text.size()) {
        text[at] = static_cast<char>(random.below(256));
      }
      break;
    default:
      text.resize(std::max(text.size() / 2, at));
  }
}

TEST(TableFuzzTest, ADamagedDefinitionIsReadOrRefusedInOneKindOfError) {
  std::ifstream in(HAPTRIAL_SOURCE_DIR "/experiments/force_training.toml");
  std::ostringstream whole;
  whole << in.rdbuf();
  ASSERT_GT(whole.str().size(), 1000u);
  RandomStream random(1, "damage");
  int parsed = 0;
  constexpr int kRounds = 4000;
  for (int round = 0; round < kRounds; ++round) {
    std::string text = whole.str();
    for (std::uint64_t i = random.below(4); i < 4; ++i) {
      damage(text, random);
    }
    try {
      Table table = Table::parse(text, "damaged.toml");
      ++parsed;
      read_all(table, 0);
      table.finish();
      ADD_FAILURE() << "the absent key was accepted";
    } catch (const InputError& error) {
      ASSERT_EQ(std::string(error.what()).rfind("damaged.toml", 0), 0u) << error.what();
    } catch (const std::exception& error) {
      FAIL() << "round " << round << ": " << error.what() << "\n" << text;
    }
  }
  // Both ways were walked.
  EXPECT_GT(parsed, kRounds / 20);
  EXPECT_LT(parsed, kRounds);
}

}  // namespace
}  // namespace haptrial
