#include "analysis/files/json_pieces.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

namespace haptrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

/// The members of an object, lists element by element.
std::string in_pieces(const Json& object, std::vector<std::string>& pieces) {
  JsonPieces json([&](const std::string& text) { pieces.push_back(text); });
  for (const auto& [name, value] : object.items()) {
    if (value.is_array()) {
      const Json& list = value;
      json.list(name, list.size(), [&](std::size_t i) { return list[i].dump(2); });
    } else {
      json.member(name, value.dump(2));
    }
  }
  json.end();
  std::string all;
  for (const std::string& piece : pieces) {
    all += piece;
  }
  return all;
}

TEST(JsonPiecesTest, TheTextIsThatOfTheWholeObject) {
  const Json object{{"title", "lines\nand \"quotes\", \t"},
                    {"nothing", nullptr},
                    {"empty", Json::array()},
                    {"empty object", Json::object()},
                    {"numbers", {1, 2.5, 1e-300}},
                    {"nested", {{"list", {{{"a", 1}, {"b", Json::array()}}, "x\ny"}}, {"c", true}}},
                    {"objects", {{{"a", {1, 2}}}, {{"a", Json::object()}}}}};
  std::vector<std::string> pieces;
  EXPECT_EQ(in_pieces(object, pieces), object.dump(2) + "\n");
  EXPECT_EQ(pieces.size(), 1u);
}

TEST(JsonPiecesTest, AnObjectWithoutMembers) {
  std::vector<std::string> pieces;
  EXPECT_EQ(in_pieces(Json::object(), pieces), "{}\n");
}

TEST(JsonPiecesTest, LongListsAreGivenInPiecesOfAMebibyte) {
  Json object{{"list", Json::array()}};
  for (int i = 0; i < 3000; ++i) {
    object["list"].push_back({{"text", std::string(1000, 'x')}});
  }
  std::vector<std::string> pieces;
  EXPECT_EQ(in_pieces(object, pieces), object.dump(2) + "\n");
  EXPECT_EQ(pieces.size(), 3u);
  for (const std::string& piece : pieces) {
    EXPECT_LT(piece.size(), std::size_t{(1 << 20) + 2000});
  }
}

}  // namespace
}  // namespace haptrial::analysis
